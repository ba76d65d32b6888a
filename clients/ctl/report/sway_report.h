#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/ctl/report/sway_trial.h"
#include "common/base/result.h"
#include "common/posturography/standing.h"

namespace footing::sway {

/// A session of quiet standing: who stood how on what, and all attempts in their order.
struct Session {
  std::string subject;
  std::string notes;
  std::int64_t wall_time_ns = 0;  ///< Its begin, UNIX time.
  std::vector<Board> boards;      ///< One or two.
  double seconds = 30;
  double settle_s = 5;
  posturography::CopFilter filter;
  std::size_t planned = 0;  ///< Trials that should count.
  std::string recording;    ///< Path.
  std::string program;      ///< "footing-ctl 0.1.0".
  std::vector<Trial> trials;
};

/// Records in a recording: a session without its trials, a trial without its measures.
nlohmann::ordered_json PlanToJson(const Session& session);
nlohmann::ordered_json TrialToJson(const Trial& trial);
/// The other way round; InvalidData says what is missing or wrong. Lengths and poses are checked.
Result<Session> PlanFromJson(const std::string& json);
Result<Trial> TrialFromJson(const std::string& json);

/// How many planned trials have no attempt that counts.
std::size_t Missing(const Session& session);
/// Reasons why the figures are worth less than they seem, for a reader.
std::vector<std::string> Warnings(const Session& session);

/// The answer of --json: the session, every attempt with its measures, means and standard
/// deviations of each condition, Romberg ratios.
nlohmann::ordered_json ToJson(const Session& session);
/// A row an attempt, with a header; measures are empty where there are none. Lines end in LF.
std::string ToCsv(const Session& session);
/// The filtered COP of all trials that count: trial,time_s,x_mm,y_mm.
std::string CopToCsv(const Session& session);
/// Conditions and their main measures for a terminal.
std::string ToText(const Session& session);
/// A page that needs no other file and prints to one page of A4: means and standard deviations,
/// Romberg ratios, the first stabilogram of each condition and its COP over time.
std::string ToHtml(const Session& session);

/// More conditions than that do not fit on a page.
inline constexpr std::size_t kMostConditions = 8;

}  // namespace footing::sway
