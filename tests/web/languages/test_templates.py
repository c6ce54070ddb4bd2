"""A template that is compiled for one reader speaks to the next in their own language."""

from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_of
from app.web.shell.render import environment


def test_fixed_texts_follow_the_language_of_each_reader() -> None:
    before = CATALOGUE.set(catalogue_of("de"))
    try:
        template = environment().from_string("{{ range_hint(0, 360, 180) }}")
        assert template.render() != "0 to 360, usual 180."
        CATALOGUE.set(catalogue_of("en"))
        assert template.render() == "0 to 360, usual 180."
    finally:
        CATALOGUE.reset(before)
