"""The frame that all pages share, and the forms and formats in it."""
