"""The drawings of pages, over one axis: what lies where, which numbers stand at it, how they are written."""
