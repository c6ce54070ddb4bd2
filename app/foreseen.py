"""What was foreseen to go wrong."""


class Foreseen(Exception):
    """Something that cannot be done; the text is a sentence for whoever asked."""
