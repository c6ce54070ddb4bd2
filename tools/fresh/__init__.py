"""`make fresh`: the README's commands on pristine Debian machines, each of them a folder."""
