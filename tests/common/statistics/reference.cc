#include "tests/common/statistics/reference.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace footing::statistics::test {
namespace {

std::string Folder() {
  const char* folder = std::getenv("FOOTING_TEST_DATA");
  return folder == nullptr || *folder == '\0' ? "" : std::string(folder) + "/stats/";
}

std::vector<std::string> SplitCells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

bool HasReferenceTables() {
  return !Folder().empty() && std::filesystem::exists(Folder() + "datasets.csv");
}

std::vector<ReferenceRow> ReadReference(const std::string& name) {
  std::ifstream file(Folder() + name);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = SplitCells(line);
  std::vector<ReferenceRow> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = SplitCells(line);
    EXPECT_EQ(cells.size(), names.size()) << name << ": " << line;
    ReferenceRow& row = rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) row[names[i]] = cells[i];
  }
  EXPECT_FALSE(names.empty()) << name;
  return rows;
}

double NumberIn(const ReferenceRow& row, const std::string& column) {
  const std::string& cell = row.at(column);
  return cell == "inf" ? Interval().high : std::stod(cell);
}

Alternative AlternativeIn(const ReferenceRow& row) {
  const std::string& name = row.at("alternative");
  if (name == "greater") return Alternative::kGreater;
  if (name == "less") return Alternative::kLess;
  EXPECT_TRUE(name == "two.sided" || name == "two-sided") << name;
  return Alternative::kTwoSided;
}

std::map<std::string, Groups> ReadDatasets() {
  std::map<std::string, Groups> datasets;
  for (const ReferenceRow& row : ReadReference("datasets.csv")) {
    Groups& groups = datasets[row.at("dataset")];
    const std::size_t index = std::stoul(row.at("group_index"));
    if (groups.size() <= index) groups.resize(index + 1);
    groups[index].name = row.at("group");
    groups[index].values.push_back(NumberIn(row, "value"));
  }
  return datasets;
}

Groups BloodCounts() {
  return {{"control", {7.4, 8.5, 7.2, 8.24, 9.84, 8.32}},
          {"drugA", {9.76, 8.8, 7.68, 9.36}},
          {"drugB", {12.8, 9.68, 12.16, 9.2, 10.55}}};
}

Groups SmallWithTies() { return {{"c", {0, 1, 1, 2}}, {"a", {1, 2, 3, 3}}, {"b", {2, 3, 3, 4}}}; }

Groups PlantGrowth() {
  return {{"ctrl", {4.17, 5.58, 5.18, 6.11, 4.5, 4.61, 5.17, 4.53, 5.33, 5.14}},
          {"trt1", {4.81, 4.17, 4.41, 3.59, 5.87, 3.83, 6.03, 4.89, 4.32, 4.69}},
          {"trt2", {6.31, 5.12, 5.54, 5.5, 5.37, 5.29, 4.92, 6.15, 5.8, 5.26}}};
}

}  // namespace footing::statistics::test
