"""The layering rules refuse what they should: each case writes a small tree and looks at the answer.

Usage: layering_test.py SOURCE_ROOT
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
sys.path.insert(0, str(ROOT / "tests/architecture"))
import check_includes  # noqa: E402
from small_tree import small_tree  # noqa: E402

EXTERNALS = "set(EXTERNAL_eigen \"\")\nset(EXTERNAL_asio \"\")\nset(EXTERNAL_PURE eigen)\n"


def configure(modules):
    """Configures a project of header-only modules, a list of (folder, add_module words)."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        lines = ["cmake_minimum_required(VERSION 3.25)", "project(tree NONE)", EXTERNALS,
                 f"include({ROOT}/common/cmake/module.cmake)"]
        for place, words in modules:
            (root / place).mkdir(parents=True)
            (root / place / "a.h").write_text("#pragma once\n")
            (root / place / "CMakeLists.txt").write_text(f"add_module({words})\n")
            lines.append(f"add_subdirectory({place})")
        (root / "CMakeLists.txt").write_text("\n".join(lines) + "\n")
        done = subprocess.run(["cmake", "-S", root, "-B", root / "build"], capture_output=True,
                              text=True, timeout=60, check=False)
        return done.returncode, " ".join(done.stderr.split())


def includes(files, table):
    with small_tree({**files, "modules.txt": table}) as root:
        return check_includes.check(root, root / "modules.txt")


class Configure(unittest.TestCase):
    def refused(self, modules, words):
        code, output = configure(modules)
        self.assertNotEqual(code, 0)
        self.assertIn(words, output)

    def test_a_right_order_configures(self):
        code, output = configure([("common/a", "a PURE HEADERS a.h DEPS eigen"),
                                  ("daemon/sensor/b", "b PURE HEADERS a.h DEPS a")])
        self.assertEqual(code, 0, output)

    def test_a_module_not_yet_declared_is_refused(self):
        self.refused([("common/a", "a HEADERS a.h DEPS b"), ("common/b", "b HEADERS a.h")],
                     "not declared above")

    def test_a_pure_module_may_not_name_an_impure_one(self):
        self.refused([("common/a", "a HEADERS a.h"), ("common/b", "b PURE HEADERS a.h DEPS a")],
                     "does I/O")

    def test_a_pure_module_may_not_name_an_impure_library(self):
        self.refused([("common/b", "b PURE HEADERS a.h DEPS asio")], "external library asio")

    def test_the_daemons_never_name_each_other(self):
        self.refused([("daemon/sensor/a", "a HEADERS a.h"),
                      ("daemon/simulation/b", "b HEADERS a.h DEPS a")], "may not name")

    def test_clients_never_name_a_daemon(self):
        self.refused([("daemon/sensor/a", "a HEADERS a.h"),
                      ("clients/b", "b HEADERS a.h DEPS a")], "may not name")

    def test_what_runs_never_names_synthetic_people_or_devices(self):
        for folder in ("daemon/sensor/b", "daemon/simulation/b", "common/b"):
            self.refused([("common/virtual/a", "a HEADERS a.h"),
                          (folder, "b HEADERS a.h DEPS a")], "no daemon contains synthetic")
            self.refused([("common/virtual/a", "a HEADERS a.h"),
                          (folder, "b HEADERS a.h PRIVATE_DEPS a")], "no daemon contains synthetic")

    def test_offline_clients_and_other_synthetic_modules_may_name_them(self):
        code, output = configure([("common/virtual/a", "a HEADERS a.h"),
                                  ("common/virtual/b", "b HEADERS a.h DEPS a"),
                                  ("daemon/offline/c", "c HEADERS a.h DEPS a"),
                                  ("clients/d", "d HEADERS a.h DEPS a")])
        self.assertEqual(code, 0, output)

    def test_a_client_never_names_another_client(self):
        self.refused([("clients/log", "a HEADERS a.h"), ("clients/ctl", "b HEADERS a.h DEPS a")],
                     "may not name")
        self.refused([("clients/log", "a HEADERS a.h"),
                      ("clients/log_reader/x", "b HEADERS a.h DEPS a")], "may not name")

    def test_a_client_may_name_its_own_modules(self):
        code, output = configure([("clients/ctl/words", "a HEADERS a.h"),
                                  ("clients/ctl/guide", "b HEADERS a.h DEPS a")])
        self.assertEqual(code, 0, output)

    def test_offline_may_name_both_daemons(self):
        code, output = configure([("daemon/sensor/a", "a HEADERS a.h"),
                                  ("daemon/simulation/b", "b HEADERS a.h"),
                                  ("daemon/offline/c", "c HEADERS a.h DEPS a b")])
        self.assertEqual(code, 0, output)


class Includes(unittest.TestCase):
    TABLE = "a|common/a|TRUE||\nb|common/b|TRUE|a|\nc|daemon/sensor/c|FALSE|asio|a\n"

    def found(self, path, text, words):
        files = {"common/a/a.h": "#pragma once\n", "common/b/b.h": "#pragma once\n"}
        files[path] = text
        errors = includes(files, self.TABLE)
        self.assertEqual(len(errors), 1, errors)
        self.assertIn(words, errors[0])

    def test_a_clean_tree_passes(self):
        self.assertEqual(includes({"common/a/a.h": "", "common/b/b.cc":
                                   '#include "common/a/a.h"\n#include <vector>\n'}, self.TABLE), [])

    def test_generated_headers_are_found_and_checked(self):
        files = {"generated/common/a/a.h": "#pragma once\n", "common/b/b.cc": '#include "common/a/a.h"\n'}
        self.assertEqual(includes(files, self.TABLE), [])
        self.found("generated/common/a/x.h", "#include <thread>\n", "pure code includes")

    def test_a_module_must_be_named(self):
        self.found("common/a/x.cc", '#include "common/b/b.h"\n', "without naming its module")

    def test_a_private_dependency_stays_out_of_headers(self):
        self.found("daemon/sensor/c/c.h", '#include "common/a/a.h"\n', "without naming its module")

    def test_folders_below_a_module_are_read(self):
        self.found("common/a/deep/er/x.cc", '#include "common/b/b.h"\n', "without naming")

    def test_our_own_header_in_angle_brackets_is_refused(self):
        self.found("common/b/x.cc", "#include <common/a/a.h>\n", "with quotes")

    def test_a_library_must_be_named(self):
        self.found("common/b/x.cc", "#include <Eigen/Core>\n", "without naming eigen")

    def test_a_header_of_nobody_is_refused(self):
        self.found("common/b/x.cc", '#include "common/a/none.h"\n', "in no module")

    def test_pure_code_has_no_thread(self):
        self.found("common/a/x.cc", "#include <thread>\n", "pure code includes")

    def test_pure_code_reads_no_clock(self):
        self.found("common/a/x.cc", "auto t = std::chrono::steady_clock::now();\n", "reads a clock")

    def test_atomics_live_in_one_folder(self):
        self.found("daemon/sensor/c/x.cc", "std::atomic<int> n;\n", "common/runtime/exchange.h only")

    def test_catching_everything_is_refused(self):
        self.found("daemon/sensor/c/x.cc", "try {} catch (...) {}\n", "catches everything")

    def test_a_source_begins_with_its_own_header(self):
        self.found("common/a/a.cc", '#include <vector>\n#include "common/a/a.h"\n', "compiled alone")

    def test_a_file_in_no_module_is_refused(self):
        self.found("clients/x.cc", "\n", "belongs to no module")


if __name__ == "__main__":
    unittest.main()
