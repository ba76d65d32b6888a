"""check_words.py finds what it should and leaves alone what it should: each case is one small file.

Usage: words_test.py SOURCE_ROOT
"""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
sys.path.insert(0, str(ROOT / "tests/architecture"))
import check_words  # noqa: E402
from small_tree import small_tree  # noqa: E402


def found(text, name="common/x.cc", exceptions=()):
    with small_tree({name: text}) as root:
        return [(f.kind, f.line, f.words) for f in check_words.check_file(root, root / name, list(exceptions))]


class Words(unittest.TestCase):
    def test_a_string_is_text_and_knows_its_line(self):
        self.assertEqual(found('int x;\nauto s = "start anew";\n'), [("text", 2, "anew")])

    def test_literals_that_touch_are_one_text(self):
        self.assertEqual(found('f("the board is "\n  "no board");\n'), [("text", 1, "is no")])

    def test_raw_literals_are_read(self):
        self.assertEqual(found('auto s = R"(\nwhat it told)";\n'), [("text", 2, "told")])

    def test_comments_of_neighbouring_lines_are_one_text(self):
        self.assertEqual(found("// what is\n// no board\n"), [("comments", 1, "is no")])

    def test_a_comment_begins_with_what_it_describes(self):
        self.assertEqual(found("double x;  ///< Of the left board.\ndouble y;  // What it weighs.\n/// What a client\n"
                               "/// asked for.\nint z = 1'000;  // Of a person's.\n"),
                         [("openings", 1, "Of"), ("openings", 2, "What"), ("openings", 3, "What"), ("openings", 5, "Of")])
        self.assertEqual(found("/// Load of the left board.\n/// What it weighs.\nint x;  // Offset.\n"
                               'auto s = "// What";  // In N,\n                     // Of course.\n'), [])
        self.assertEqual(found("// What it told.\n", "tests/x.cc"), [("openings", 1, "What")])
        self.assertEqual(found("int64 at_ns = 1;  // Of the exposure.\n", "proto/x.proto"), [("openings", 1, "Of")])

    def test_identifiers_are_read_word_by_word(self):
        self.assertEqual(found("int told_m; Bookshop stock; class RoleBook {};\n"),
                         [("names", 1, "told_m"), ("names", 1, "RoleBook")])

    def test_includes_and_longer_words_are_left_alone(self):
        self.assertEqual(found('#include "x/told.h"\nauto s = "a foretold, roomy bookend";\n'), [])

    def test_keys_with_underscores_are_left_alone(self):
        self.assertEqual(found('j["told_sd_m"] = 1;\n'), [])

    def test_no_longer_and_there_is_no_are_plain(self):
        self.assertEqual(found("It is no longer there; there is no board, nor there are no hands.\n",
                               "docs/x.md"), [])

    def test_a_proto_file_is_read_for_its_comments_only(self):
        self.assertEqual(found("bool told = 1;  // As told.\n", "proto/x.proto"), [("text", 1, "told")])

    def test_prose_of_pages_has_words_of_its_own(self):
        self.assertEqual(found("Clips that were\nleft out, and the p of a test; p < 0.05, a p value, `aim`.\n", "docs/x.md"),
                         [("pages", 2, "left out"), ("pages", 2, "p")])
        self.assertEqual(found('auto s = "left out";\n'), [])

    def test_a_chain_of_that_of_is_found(self):
        self.assertEqual([f[:2] for f in found("The error is that of the hand and those of the feet.\n", "docs/x.md")],
                         [("pages", 1)])

    def test_a_sentence_of_a_page_ends_within_35_words(self):
        short, long = "Five words make a sentence. ", " ".join(["Word"] * 36) + "."
        self.assertEqual(found(short * 20, "docs/x.md"), [])
        self.assertEqual(found(short + "\n" + long, "docs/x.md"), [("sentences", 2, "36 words")])

    def test_tables_code_headings_and_items_are_no_sentence(self):
        words = " ".join(["word"] * 30)
        self.assertEqual(found(f"# {words}\n{words}:\n- {words}\n- {words}\n\n| {words} {words} |\n\n    {words} {words}\n"
                               f"```\n{words} {words}\n```\n", "docs/x.md"), [])

    def test_an_exception_holds_for_its_path_only(self):
        text = "Norman, The Book of Signals\n"
        self.assertEqual(found(text, "docs/x.md", [("docs/", "The Book of Signals")]), [])
        self.assertEqual(len(found(text, "docs/x.md", [("common/", "The Book of Signals")])), 1)

    def test_a_folder_may_have_what_it_is_allowed_and_no_more(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("common/cli", "scripts", "daemon", "clients", "proto", "docs"):
                (root / name).mkdir(parents=True)
            (root / "common/cli/a.cc").write_text('auto a = "anew", b = "told";\n')
            self.assertEqual(check_words.check(root, [], {("text", "common/cli"): 2})[2], set())
            self.assertEqual(check_words.check(root, [], {("text", "common/cli"): 1})[2],
                             {("text", "common/cli")})


if __name__ == "__main__":
    unittest.main()
