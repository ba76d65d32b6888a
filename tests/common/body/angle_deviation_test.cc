#include "common/body/angle_deviation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "common/body/body.h"

namespace footing::body {
namespace {

TEST(AngleDeviations, AreThoseOfAnglesOfEitherSide) {
  ASSERT_TRUE(CoordinateDeviation("hip_flexion_r"));
  EXPECT_EQ(CoordinateDeviation("hip_flexion_r")->name, "hip_flexion");
  EXPECT_TRUE(CoordinateDeviation("pelvis_tilt"));
  EXPECT_FALSE(CoordinateDeviation("pelvis_tx"));
  EXPECT_FALSE(CoordinateDeviation("time"));
}

TEST(AngleDeviations, EachLinkHasOne) {
  const Skeleton person = StandardPerson(1.75);
  std::vector<std::string> names;
  std::vector<int> parents;
  for (const Joint& joint : person.joints) {
    names.push_back(joint.name);
    parents.push_back(joint.parent);
  }
  const auto deviations = DeviationsOfLinks(names, parents);
  ASSERT_EQ(deviations.size(), names.size());
  const auto of = [&](const char* name) {
    return deviations[static_cast<std::size_t>(FindJoint(person, name))].name;
  };
  EXPECT_EQ(of("root"), "pelvis");
  EXPECT_EQ(of("rfemur"), "thigh");
  EXPECT_EQ(of("ltibia"), "shank");
  EXPECT_EQ(of("lfoot"), "foot");
  EXPECT_EQ(of("ltoes"), "foot");  // Hangs on it.
  EXPECT_EQ(of("rhumerus"), "upper_arm");
  EXPECT_TRUE(
      DeviationsOfLinks(std::vector<std::string>{"root", "spine"}, std::vector{-1, 0}).empty());
  EXPECT_TRUE(DeviationsOfLinks(std::vector<std::string>{"root"}, std::vector{3}).empty());
}

/// The largest figures of a table of docs/measurements, whose cells are "upright; bent" degrees, by
/// the names of its rows.
std::map<std::string, AngleDeviation> LargestMeasured(const std::string& table) {
  std::ifstream file(std::string(FOOTING_SOURCE_DIR) + "/docs/measurements/" + table + ".csv");
  std::map<std::string, AngleDeviation> largest;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string what, value, unit;
    std::getline(cells, what, ',');
    std::getline(cells, value, ',');
    std::getline(cells, unit, ',');
    if (unit != "degrees") continue;
    std::string name = what.substr(0, what.find(" @"));
    std::replace(name.begin(), name.end(), ' ', '_');
    AngleDeviation& most = largest[name];
    most.upright_deg = std::max(most.upright_deg, std::stod(value));
    const std::string bent = value.substr(value.find(';') + 1);
    if (bent.find('-') == std::string::npos)
      most.bent_deg = std::max(most.bent_deg, std::stod(bent));
  }
  return largest;
}

TEST(AngleDeviations, AreTheLargestMeasuredErrorsInWholeDegrees) {
  for (const auto& [table, stated] : {std::pair("pose-angles", CoordinateDeviations()),
                                      std::pair("pose-orientations", LinkDeviations())}) {
    const auto measured = LargestMeasured(table);
    ASSERT_EQ(measured.size(), stated.size()) << table;
    for (const AngleDeviation& one : stated) {
      const auto found = measured.find(std::string(one.name));
      ASSERT_NE(found, measured.end()) << one.name;
      EXPECT_EQ(one.upright_deg, std::ceil(found->second.upright_deg)) << one.name;
      EXPECT_EQ(one.bent_deg, std::ceil(found->second.bent_deg)) << one.name;
    }
  }
}

}  // namespace
}  // namespace footing::body
