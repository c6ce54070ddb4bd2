"""A language: what its recipe changes and adds, and the proof that it works."""

ITALIAN = """        Language(
            "it",
            "it",
            "Italiano",
            ",",
            "%d/%m/%Y",
            _points("N", "E", "S", "O"),
            {" and ": " e ", " or ": " o "},
        ),
        Language("zh_Hans","""
CATALOGUE = r"""msgid ""
msgstr ""
"Language: it\n"
"MIME-Version: 1.0\n"
"Content-Type: text/plain; charset=utf-8\n"
"Content-Transfer-Encoding: 8bit\n"

msgid "Save protections"
msgstr "Salva le protezioni"
"""
EDITS = {
    "app/web/languages/known.py": (('        Language("zh_Hans",', ITALIAN),),
    "tests/web/languages/test_catalogues.py": (('"ro": 3,', '"ro": 3, "it": 2,'),),
}
NEW = {"app/web/locale/it/LC_MESSAGES/heliopanel.po": CATALOGUE}
PROOF = """

from app.web.languages.known import LANGUAGES, TRANSLATED
from app.web.translation.catalogues import mo_bytes, path_of, read
from tests.web.languages.test_catalogues import PLURAL_FORMS

path_of("it", "mo").write_bytes(mo_bytes(read("it")))
assert set(PLURAL_FORMS) == set(TRANSLATED), PLURAL_FORMS
assert read("it").num_plurals == PLURAL_FORMS["it"], read("it").num_plurals
assert len(set(LANGUAGES["it"].compass)) == 16


async def seen():
    async with serving(fake_app(FakeMachine(), FakeReader())) as client:
        path = "/trackers/T1/protections"
        page = (await client.get(path, headers={"accept-language": "it"})).text
        assert "Salva le protezioni" in page and 'lang="it"' in page, page
        english = (await client.get(path)).text
        assert "Save protections" in english and "Italiano" in english, "the list of languages"
"""
