"""What proto/generate_structs.py writes of small messages, and which tables it rejects.

Usage: generate_structs_test.py SOURCE_ROOT PROTOC
"""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
PROTOC = sys.argv.pop(2)
sys.path.insert(0, str(pathlib.Path(sys.argv.pop(1)).resolve() / "proto"))
import generate_structs  # noqa: E402

PROTO = """syntax = "proto3";
package footing.v1;
enum Colour { COLOUR_UNSPECIFIED = 0; COLOUR_DARK_RED = 1; COLOUR_BLUE = 2; }
message Vector3 { double x = 1; double y = 2; double z = 3; }
// A lamp.
message Lamp {
  string name = 1;  // What it is called.
  Colour colour = 2;
  Vector3 place_m = 3;
  double x = 4;
  double y = 5;
}
message Row { repeated Lamp lamps = 1; Lamp spare = 2; }
"""


def generate(table, which="structs"):
    """Path to text of what is written."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "footing/v1").mkdir(parents=True)
        proto = root / "footing/v1/lamp.proto"
        proto.write_text(PROTO)
        (root / "table.toml").write_text(table)
        generate_structs.main(which, root / "out", root / "table.toml", PROTOC, proto)
        return {path.relative_to(root / "out").as_posix(): path.read_text()
                for path in (root / "out").rglob("*") if path.is_file()}


HEADERS = '[headers]\ncolour = ["Colour"]\nlamp = ["Lamp", "Row"]\n'


class Structs(unittest.TestCase):
    def test_a_struct_has_the_fields_and_comments_of_its_message(self):
        text = generate(HEADERS)["common/stream/lamp.h"]
        self.assertIn("/// A lamp.\nstruct Lamp {\n  std::string name;  ///< What it is called.\n", text)
        self.assertIn("  Colour colour = Colour::kUnspecified;\n", text)
        self.assertIn("  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();\n", text)
        self.assertIn("  std::vector<Lamp> lamps;\n", text)
        self.assertIn('#include "common/stream/colour.h"\n', text)
        self.assertNotIn("pb.h", text)

    def test_an_enum_has_its_values_and_names(self):
        files = generate(HEADERS + '[Colour]\nnames = {blue = "navy"}\nall = "kColours"\n')
        self.assertIn("  kDarkRed = 1,\n", files["common/stream/colour.h"])
        self.assertIn("std::array kColours{Colour::kDarkRed, Colour::kBlue};", files["common/stream/colour.h"])
        self.assertIn('{"unknown", "dark_red", "navy"}', files["common/stream/messages.cc"])

    def test_options_change_members(self):
        text = generate(HEADERS + '[Lamp]\nat = {of = ["x", "y"]}\nname = {member = "label"}\n'
                        '[Row]\nspare = {optional = true}\n')["common/stream/lamp.h"]
        self.assertIn("  Eigen::Vector2d at = Eigen::Vector2d::Zero();\n", text)
        self.assertIn("  std::string label;", text)
        self.assertIn("  std::optional<Lamp> spare = std::nullopt;\n", text)

    def test_members_of_a_part_are_in_a_struct_of_their_own(self):
        text = generate(HEADERS + '[Lamp]\nparts = {paint = ["Paint", "How it is painted."]}\n'
                        'colour = {member = "paint.colour"}\n')["common/stream/lamp.h"]
        self.assertIn("/// How it is painted.\nstruct Paint {\n  Colour colour = Colour::kUnspecified;\n", text)
        self.assertIn("  Paint paint = {};\n", text)


class Conversions(unittest.TestCase):
    def test_numbers_are_finite_and_enums_known(self):
        text = generate(HEADERS, "conversions")["common/wire/messages.cc"]
        self.assertIn("  message.set_x(Finite(value.x));\n", text)
        self.assertIn("  value.x = Finite(message.x());\n", text)
        self.assertIn("  message.set_name(Utf8(value.name));\n", text)
        self.assertIn("Known<stream::Colour>(message.colour(), &v1::Colour_IsValid)", text)

    def test_what_may_come_in_as_it_is_has_a_way_of_its_own(self):
        text = generate(HEADERS + "[Row]\nlamps = {as_is = true}\n", "conversions")["common/wire/messages.cc"]
        self.assertIn("value.lamps.push_back(AsIs(one));", text)
        self.assertIn("value.spare = FromProto(message.spare());", text)
        self.assertIn("  value.x = message.x();\n", text)


class Rejected(unittest.TestCase):
    def rejected(self, table, words):
        with self.assertRaisesRegex(generate_structs.Unclear, words):
            generate(table)

    def test_a_name_that_is_in_no_proto(self):
        self.rejected('[headers]\nlamp = ["Lantern"]\n', "no message or enum Lantern")

    def test_a_message_whose_part_has_no_struct(self):
        self.rejected('[headers]\nlamp = ["Lamp"]\n', "Colour has no struct")

    def test_an_option_of_a_field_that_is_not_there(self):
        self.rejected(HEADERS + "[Lamp]\nheight = {default = \"1\"}\n", "Lamp has no field height")

    def test_an_unknown_option(self):
        self.rejected(HEADERS + "[Lamp]\nname = {shape = 1}\n", "unknown option shape")
        self.rejected(HEADERS + "[Colour]\nshape = 1\n", "unknown option shape")

    def test_a_table_of_what_has_no_struct(self):
        self.rejected(HEADERS + "[Lantern]\nname = {member = \"x\"}\n", "Lantern is in no header")


if __name__ == "__main__":
    unittest.main()
