#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "clients/study/plan/protocol.h"
#include "common/runtime/files.h"

namespace footing::study::plan {
namespace {

using nlohmann::json;

/// The parts of JSON Schema that the protocol's schema uses; empty: `value` is valid. Another
/// keyword is a fault of its own, so that none goes unchecked.
class Validator {
 public:
  std::string Check(const json& schema, const json& value, const std::string& place) {
    for (const auto& [keyword, wanted] : schema.items()) {
      const std::string fault = CheckKeyword(keyword, wanted, schema, value, place);
      if (!fault.empty()) return fault;
    }
    return "";
  }

 private:
  static bool HasType(const std::string& type, const json& value) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "integer") return value.is_number_integer();
    return type == "number" && value.is_number();
  }

  std::string CheckKeyword(const std::string& keyword, const json& wanted, const json& schema,
                           const json& value, const std::string& place) {
    const auto fault_unless = [&](bool good) {
      return good ? std::string() : place + ": " + keyword + " " + wanted.dump();
    };
    if (keyword == "$schema" || keyword == "title" || keyword == "description") return "";
    if (keyword == "type") return fault_unless(HasType(wanted, value));
    if (keyword == "const") return fault_unless(value == wanted);
    if (keyword == "enum") {
      return fault_unless(std::find(wanted.begin(), wanted.end(), value) != wanted.end());
    }
    if (keyword == "minimum") return fault_unless(!value.is_number() || value >= wanted);
    if (keyword == "maximum") return fault_unless(!value.is_number() || value <= wanted);
    if (keyword == "minItems")
      return fault_unless(!value.is_array() || json(value.size()) >= wanted);
    if (keyword == "maxItems")
      return fault_unless(!value.is_array() || json(value.size()) <= wanted);
    if (keyword == "uniqueItems") {
      if (!value.is_array()) return "";
      return fault_unless(std::set<json>(value.begin(), value.end()).size() == value.size());
    }
    if (keyword == "pattern") {
      const std::regex pattern(wanted.get<std::string>());
      return fault_unless(!value.is_string() ||
                          std::regex_search(value.get<std::string>(), pattern));
    }
    if (keyword == "required") {
      for (const json& key : wanted) {
        if (value.is_object() && !value.contains(key)) return fault_unless(false);
      }
      return "";
    }
    if (keyword == "items" || keyword == "properties")
      return CheckInside(keyword, wanted, value, place);
    if (keyword == "additionalProperties" && wanted == false) {
      if (!value.is_object()) return "";
      for (const auto& [key, inner] : value.items()) {
        if (!schema["properties"].contains(key)) return place + ": unknown key " + key;
      }
      return "";
    }
    return place + ": the test does not know the keyword " + keyword;
  }

  std::string CheckInside(const std::string& keyword, const json& wanted, const json& value,
                          const std::string& place) {
    if (!(keyword == "items" ? value.is_array() : value.is_object())) return "";
    for (const auto& [key, inner] : value.items()) {
      if (keyword == "properties" && !wanted.contains(key)) continue;
      const json& schema = keyword == "items" ? wanted : wanted[key];
      const std::string fault = Check(schema, inner, place + "." + key);
      if (!fault.empty()) return fault;
    }
    return "";
  }
};

json Schema() {
  const auto text = config::ReadDataFile("study_protocol.schema.json");
  EXPECT_TRUE(text) << text.error().message;
  return json::parse(*text);
}

json Least() {
  return {{"version", 1},
          {"name", "n"},
          {"participants", {"P1"}},
          {"interfaces", {"wrist", "arm", "leg", "joystick", "boards"}},
          {"seed", 3}};
}

std::string Read(const json& protocol) {
  const auto read = ParseProtocol(protocol.dump(), "a.json");
  return read ? "" : read.error().message;
}

bool Agree(const json& protocol) {
  return Read(protocol).empty() == Validator().Check(Schema(), protocol, "").empty();
}

/// The keys that the reader says there are, of the object at a key; empty: of the whole protocol.
std::set<std::string> KeysOfReader(const std::string& object) {
  json protocol = Least();
  (object.empty() ? protocol : protocol[object])["no such key"] = 1;
  const std::string message = Read(protocol);
  const std::string before = "there are: ";
  const auto at = message.find(before);
  EXPECT_NE(at, std::string::npos) << message;
  std::set<std::string> keys;
  std::istringstream list(message.substr(at + before.size()));
  for (std::string key; std::getline(list >> std::ws, key, ',');) keys.insert(key);
  return keys;
}

std::set<std::string> KeysOf(const json& properties) {
  std::set<std::string> keys;
  for (const auto& [key, schema] : properties.items()) keys.insert(key);
  return keys;
}

TEST(ProtocolSchema, HasTheKeysOfTheReader) {
  const json properties = Schema()["properties"];
  EXPECT_EQ(KeysOf(properties), KeysOfReader(""));
  for (const auto& [key, schema] : properties.items()) {
    if (!schema.contains("properties")) continue;
    EXPECT_EQ(KeysOf(schema["properties"]), KeysOfReader(key)) << key;
  }
}

TEST(ProtocolSchema, AcceptsTheExamples) {
  for (const char* name : {"study.json", "latency.json"}) {
    const auto text =
        config::ReadTextFile(std::string(FOOTING_SOURCE_DIR "/docs/examples/") + name);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ(Validator().Check(Schema(), json::parse(*text), name), "");
    EXPECT_EQ(Read(json::parse(*text)), "");
  }
}

/// Values at and beyond what a schema of one key says.
std::vector<json> Probes(const json& schema) {
  std::vector<json> probes = {nullptr, true, 1, 1.5, "a text", json::array(), json::object()};
  for (const char* end : {"minimum", "maximum"}) {
    if (!schema.contains(end)) continue;
    const double limit = schema[end];
    const bool integer = schema["type"] == "integer";
    for (const double beyond : {-1.0, 0.0, 1.0}) {
      const double value = limit + beyond;
      if (integer && value < 0) {
        probes.push_back(static_cast<std::int64_t>(value));
      } else {
        probes.push_back(integer ? json(static_cast<std::uint64_t>(value)) : json(value));
      }
    }
  }
  if (schema.contains("enum"))
    probes.insert(probes.end(), schema["enum"].begin(), schema["enum"].end());
  if (schema.contains("maxItems")) {
    for (const std::size_t count :
         {schema["maxItems"].get<std::size_t>(), schema["maxItems"].get<std::size_t>() + 1}) {
      json list = json::array();
      for (std::size_t i = 0; i < count; ++i) list.push_back("item" + std::to_string(i));
      probes.push_back(list);
    }
    probes.push_back({"same", "same"});
    probes.push_back({1});
  }
  return probes;
}

TEST(ProtocolSchema, AcceptsWhatTheReaderAccepts) {
  std::size_t accepted = 0, refused = 0;
  const auto probe = [&](const json& protocol, const std::string& key, const json& value) {
    EXPECT_TRUE(Agree(protocol)) << key << " = " << value.dump().substr(0, 200)
                                 << ": reader: " << Read(protocol)
                                 << "; schema: " << Validator().Check(Schema(), protocol, "");
    ++(Read(protocol).empty() ? accepted : refused);
  };
  const json properties = Schema()["properties"];
  for (const auto& [key, schema] : properties.items()) {
    for (const json& value : Probes(schema)) {
      json protocol = Least();
      protocol[key] = value;
      probe(protocol, key, value);
    }
    if (!schema.contains("properties")) continue;
    for (const auto& [inner, inner_schema] : schema["properties"].items()) {
      for (const json& value : Probes(inner_schema)) {
        json protocol = Least();
        protocol[key][inner] = value;
        probe(protocol, key + "." + inner, value);
      }
    }
  }
  EXPECT_GT(accepted, 60u);
  EXPECT_GT(refused, 200u);
}

TEST(ProtocolSchema, RefusesWhatIsMissingAndCodesThatAreNone) {
  for (const char* key : {"version", "name", "participants", "interfaces", "seed"}) {
    json protocol = Least();
    protocol.erase(key);
    EXPECT_THAT(Validator().Check(Schema(), protocol, ""), testing::HasSubstr("required"));
    EXPECT_THAT(Read(protocol), testing::HasSubstr(std::string(key) + " is missing"));
  }
  for (const char* code : {"", "../x", "a b", "12345678901234567"}) {
    json protocol = Least();
    protocol["participants"] = {code};
    EXPECT_THAT(Validator().Check(Schema(), protocol, ""), testing::HasSubstr("pattern")) << code;
    EXPECT_NE(Read(protocol), "") << code;
  }
}

}  // namespace
}  // namespace footing::study::plan
