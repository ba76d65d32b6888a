#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/study/report/analysis.h"
#include "clients/study/report/trials.h"

/// The report as HTML, and its tables.
namespace footing::study::report {

/// Four significant digits, or an en dash where there is no number.
std::string Short(const nlohmann::ordered_json& object, const char* key);
/// A p for a reader: four decimals, or an en dash.
std::string PText(const nlohmann::ordered_json& object, const char* key);
/// The p of a row of independent groups; with one value in each there is nothing to test.
std::string IndependentPText(const nlohmann::ordered_json& row);
/// Name of the comparison in a row of a test.
std::string NameOfRow(const nlohmann::ordered_json& row);

/// A row for each measure of an analysis: the median of each interface, in their order, with the p
/// to believe against the control where it is below 0.05: of the paired test, or marked as that of
/// independent groups.
std::string OverviewTable(const nlohmann::ordered_json& analysis,
                          const std::vector<std::string>& interfaces);
/// The groups of a measure.
std::string GroupTable(const nlohmann::ordered_json& groups);
/// A report of footing-eval stats on independent groups, or its error: p and effect sizes with
/// their intervals.
std::string TestTable(const nlohmann::ordered_json& test);
/// Table of the tests within participants: permutation, Wilcoxon, blocked Dunnett.
std::string PairedTable(const nlohmann::ordered_json& paired);
/// Result of Friedman's test, in a sentence; empty: none.
std::string FriedmanText(const nlohmann::ordered_json& paired);
/// A ratio of failure rates as a line of text.
std::string RateText(const nlohmann::ordered_json& row);
/// Table of failure rates and their ratios.
std::string RateTable(const nlohmann::ordered_json& rate);
std::string LatencyTable(const std::vector<StageLatency>& latency);
/// Ratings that are about no interface; empty: there are none.
std::string WholeStudyTable(const std::vector<records::Records>& people);
/// The free text, without codes; empty: there is none.
std::string AnswerTable(const std::vector<records::Records>& people);

/// The report as one HTML page that needs no other file: for each measure its figure, its numbers
/// and its tests, then the free-text answers.
std::string Page(const Analysis& analysis, const plan::Protocol& protocol,
                 const std::vector<records::Records>& people);

/// Numbers of the page as lines of text.
std::string Summary(const Analysis& analysis);

}  // namespace footing::study::report
