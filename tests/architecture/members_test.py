"""The check of data members refuses what it should: each case writes a small tree and looks at the answer.

Usage: members_test.py SOURCE_ROOT
"""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
sys.path.insert(0, str(ROOT / "tests/architecture"))
import check_members  # noqa: E402
from small_tree import small_tree  # noqa: E402


def checked(text, tables=None):
    with small_tree({"common/a/a.h": text}) as root:
        return check_members.check(root, tables or {})


def problems(text, tables=None):
    return checked(text, tables)[0]


def members(body):
    """As the check counts them in the first class."""
    return next(iter(check_members.classes("struct A {\n" + body + "};\n")))[2]


def fields(count):
    return "".join(f"  int a{i} = 0;\n" for i in range(count))


class Members(unittest.TestCase):
    def test_a_class_has_at_most_20_data_members(self):
        for head in ("struct A", "class A final : public B<int>", "class A::Implementation", "union A"):
            self.assertEqual(problems(head + " {\n" + fields(20) + "};\n"), [], head)
            found = problems("namespace b {\n" + head + " {\n" + fields(21) + "};\n}\n")
            self.assertEqual(len(found), 1, head)
            self.assertIn("common/a/a.h:2: A", found[0])
            self.assertIn("21 data members", found[0])

    def test_each_declarator_counts(self):
        self.assertEqual(members("  double a = 0, b = 0;\n"), 2)
        self.assertEqual(members("  std::map<int, std::pair<int, int>> a, b;\n"), 2)
        self.assertEqual(members("  int a[3] = {1, 2, 3}, b{4};\n"), 2)
        self.assertEqual(members("  std::function<void(int, int)> a;\n  const A& b;\n  void (*c)(int, int) = nullptr;\n"), 3)
        self.assertEqual(members(" public:\n  int a;\n private:\n  int b : 3;\n  [[maybe_unused]] int c = F(1, 2);\n"), 3)

    def test_functions_types_and_constants_are_no_data_members(self):
        for body in ("  explicit A(int b, int c);\n", "  A(int b) : b_(b), c_{b} {}\n", "  A& operator=(const A&) = delete;\n",
                     "  int F(int b) const { int c = 0, d = 0; return c + d; }\n  int G() const = 0;\n",
                     "  bool operator==(const A&) const = default;\n", "  static constexpr int kB = 1, kC = 2;\n",
                     "  using B = int;\n  friend class C;\n  class D;\n  enum class E { kF, kG };\n",
                     "  template <typename T, typename U>\n  void F(T t, U u) {}\n", "  // int a; int b;\n"):
            self.assertEqual(members(body), 0, body)

    def test_members_of_members_count_to_their_own_class(self):
        self.assertEqual(members("  struct B {\n    int c, d;\n  };\n  B b;\n"), 1)
        self.assertEqual(members("  struct {\n    int c, d;\n  } b, e;\n"), 2)
        nested = "class A {\n  struct B {\n" + fields(21) + "  };\n};\n"
        self.assertIn("common/a/a.h:2: B has 21", problems(nested)[0])

    def test_a_table_of_values_has_a_ceiling(self):
        table = "struct A {\n" + fields(22) + "  bool operator==(const A&) const = default;\n};\n"
        self.assertEqual(problems(table, {"common/a/a.h:A": (22, "a message")}), [])
        self.assertIn("22 data members", problems(table, {"common/a/a.h:A": (21, "a message")})[0])

    def test_a_class_with_functions_is_no_table_of_values(self):
        for function in ("  void Advance();\n", "  A(int b) : a0(b) {}\n", "  static A Of(int b);\n",
                         "  template <typename T>\n  void F(T t);\n"):
            found = problems("struct A {\n" + function + fields(21) + "};\n", {"common/a/a.h:A": (21, "a message")})
            self.assertEqual(len(found), 1, function)
            self.assertIn("no table of values", found[0])

    def test_a_table_without_need_is_named(self):
        self.assertEqual(checked("struct A {\n" + fields(20) + "};\n", {"common/a/a.h:A": (21, "a message")}),
                         ([], ["common/a/a.h:A"]))


if __name__ == "__main__":
    unittest.main()
