"""The site of the documents: built by zensical, finished and checked here; and the pages made of the code."""
