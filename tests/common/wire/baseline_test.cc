#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>

#include "footing/v1/lsl.pb.h"
#include "footing/v1/model.pb.h"
#include "footing/v1/session.pb.h"

/// Within footing.v1 only additions: every line of the committed baseline still holds. A line is
/// one field, oneof member or enum value with its number and type. Run with
/// FOOTING_WRITE_BASELINE=1 to add what is new; lines that vanished keep the test failing until the
/// protocol's version changes.
namespace footing {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::FileDescriptor;
using Lines = std::set<std::string>;

const char* const kBaseline = FOOTING_SOURCE_DIR "/tests/common/wire/footing_v1.baseline";

std::string TypeOf(const FieldDescriptor* field) {
  std::string type = field->type_name();
  if (field->message_type() != nullptr) type = field->message_type()->full_name();
  if (field->enum_type() != nullptr) type = field->enum_type()->full_name();
  if (field->is_repeated()) type = "repeated " + type;
  if (field->has_optional_keyword()) type = "optional " + type;
  if (field->real_containing_oneof() != nullptr) {
    type += " in oneof " + field->real_containing_oneof()->name();
  }
  return type;
}

void Describe(const EnumDescriptor* type, Lines& lines) {
  for (int i = 0; i < type->value_count(); ++i) {
    lines.insert(type->full_name() + " " + std::to_string(type->value(i)->number()) + " " +
                 type->value(i)->name());
  }
}

void Describe(const Descriptor* type, Lines& lines) {
  lines.insert("message " + type->full_name());
  for (int i = 0; i < type->field_count(); ++i) {
    const FieldDescriptor* field = type->field(i);
    lines.insert(type->full_name() + " " + std::to_string(field->number()) + " " + field->name() +
                 " " + TypeOf(field));
  }
  for (int i = 0; i < type->nested_type_count(); ++i) Describe(type->nested_type(i), lines);
  for (int i = 0; i < type->enum_type_count(); ++i) Describe(type->enum_type(i), lines);
}

void Describe(const FileDescriptor* file, Lines& lines) {
  for (int i = 0; i < file->message_type_count(); ++i) Describe(file->message_type(i), lines);
  for (int i = 0; i < file->enum_type_count(); ++i) Describe(file->enum_type(i), lines);
  for (int i = 0; i < file->dependency_count(); ++i) Describe(file->dependency(i), lines);
}

Lines Current() {
  Lines lines;
  Describe(v1::Envelope::descriptor()->file(), lines);
  Describe(v1::Model::descriptor()->file(), lines);
  Describe(v1::LslSamples::descriptor()->file(), lines);
  return lines;
}

Lines Baseline() {
  Lines lines;
  std::ifstream file(kBaseline);
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) lines.insert(line);
  }
  return lines;
}

Lines Without(const Lines& lines, const Lines& others) {
  Lines rest;
  std::set_difference(lines.begin(), lines.end(), others.begin(), others.end(),
                      std::inserter(rest, rest.end()));
  return rest;
}

TEST(Baseline, NothingOfVersion1IsRenumberedRetypedRenamedOrRemoved) {
  const Lines baseline = Baseline();
  ASSERT_GT(baseline.size(), 250u) << "unreadable: " << kBaseline;
  for (const std::string& line : Without(baseline, Current())) {
    ADD_FAILURE() << "in the baseline and not in the protocol any more: " << line;
  }
}

TEST(Baseline, WhatIsNewIsWrittenDown) {
  const Lines added = Without(Current(), Baseline());
  if (!added.empty() && std::getenv("FOOTING_WRITE_BASELINE") != nullptr) {
    Lines all = Baseline();
    all.insert(added.begin(), added.end());
    std::ofstream file(kBaseline);
    for (const std::string& line : all) file << line << "\n";
    return;
  }
  for (const std::string& line : added) {
    ADD_FAILURE() << "new, run this test with FOOTING_WRITE_BASELINE=1 and commit: " << line;
  }
}

TEST(Baseline, EveryEnumBeginsWithUnspecified) {
  for (const std::string& line : Current()) {
    if (line.find(" 0 ") == std::string::npos) continue;
    EXPECT_NE(line.find("UNSPECIFIED"), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace footing
