"""How a template is laid out is none of what a page weighs; what people typed stays as it was."""

from app.web.shell.render import environment


def test_what_a_template_writes_has_single_spaces_and_values_stay() -> None:
    page = environment().from_string('<p\n    class="a">\n  one\n  {{ typed }}\n</p>')
    assert page.render(typed="1,2\n  3,4") == '<p class="a"> one 1,2\n  3,4 </p>'
