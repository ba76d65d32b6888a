#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/statistics/samples.h"

/// The tables of reference figures in FOOTING_TEST_DATA/stats, and small data sets of textbooks.
namespace footing::statistics::test {

bool HasReferenceTables();

using ReferenceRow = std::map<std::string, std::string>;
std::vector<ReferenceRow> ReadReference(const std::string& name);

double NumberIn(const ReferenceRow& row, const std::string& column);
Alternative AlternativeIn(const ReferenceRow& row);

/// By name; the control first.
std::map<std::string, Groups> ReadDatasets();

/// Blood counts of rats after two drugs (Dunnett 1955): 6, 4 and 5 values.
Groups BloodCounts();
/// Twelve made-up values with ties: 4, 4 and 4.
Groups SmallWithTies();
/// Dried weights of plants (Dobson 1983): 10, 10 and 10 values.
Groups PlantGrowth();

}  // namespace footing::statistics::test

#define SKIP_WITHOUT_REFERENCE_TABLES()                   \
  if (!footing::statistics::test::HasReferenceTables()) { \
    GTEST_SKIP() << "needs FOOTING_TEST_DATA/stats";      \
  }
