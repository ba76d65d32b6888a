"""The check of sizes refuses what it should: each case writes a small tree and looks at the answer.

Usage: size_test.py SOURCE_ROOT
"""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
sys.path.insert(0, str(ROOT / "tests/architecture"))
import check_size  # noqa: E402
from small_tree import small_tree  # noqa: E402


def problems(text, exceptions=None):
    with small_tree({"common/a/a.cc": text}) as root:
        return check_size.check(root, exceptions or {})[0]


def function(head, lines):
    """A function of this many lines, the head's last line and the closing brace among them."""
    return head + " {\n" + "  Call();\n" * (lines - 2) + "}\n"


class Size(unittest.TestCase):
    def test_a_file_may_be_long(self):
        self.assertEqual(problems("int a;\n" * 1000), [])

    def test_a_function_has_at_most_60_lines(self):
        self.assertEqual(problems(function("void Short()", 60)), [])
        for head in ("void Long(int a)", "Result<int> A::Long() const", "A::Long(int b) : b_(b), c_{b}",
                     "template <typename T>\nauto Long(T t) -> int", "int main(int argc, char** argv)"):
            found = problems("namespace a {\nstruct B {\n  int c = 0;\n};\n" + function(head, 61) + "}\n")
            self.assertEqual(len(found), 1, head)
            self.assertIn("common/a/a.cc:", found[0])

    def test_a_lambda_counts_to_its_function(self):
        body = "void Outer() {\n  Do([] {\n" + "    Call();\n" * 60 + "  });\n}\n"
        self.assertIn("Outer has 64 lines", problems(body)[0])

    def test_tables_texts_and_comments_are_no_functions(self):
        self.assertEqual(problems("constexpr int kTable[] = {\n" + "  1,\n" * 80 + "};\n"), [])
        self.assertEqual(problems('const char* kText = R"(void F() {\n' + "x\n" * 80 + '})";\n'), [])
        self.assertEqual(problems("// void F() {\n" + "// x\n" * 80 + "// }\n"), [])

    def test_an_exception_has_a_ceiling(self):
        allowed = {"common/a/a.cc:Long": (61, "a table")}
        self.assertEqual(problems(function("void Long()", 61), allowed), [])
        self.assertEqual(len(problems(function("void Long()", 62), allowed)), 1)


if __name__ == "__main__":
    unittest.main()
