#include "clients/ctl/report/sway_report.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/plot/line_plot.h"
#include "common/stream/roles.h"

namespace footing::sway {
namespace {

using nlohmann::ordered_json;
using posturography::CopSample;

ordered_json OrNull(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json ToJson(const Condition& condition) {
  return {{"eyes", condition.eyes}, {"surface", condition.surface}, {"feet", condition.feet}};
}

std::string OneOf(const ordered_json& json, const char* key,
                  const std::vector<std::string>& values) {
  std::string value = json.at(key).get<std::string>();
  if (std::find(values.begin(), values.end(), value) != values.end()) return value;
  throw std::out_of_range(std::string(key) + " is " + text::Quoted(value));
}

double Between(const ordered_json& json, const char* key, double least, double most) {
  const double value = json.at(key).get<double>();
  if (value >= least && value <= most) return value;
  throw std::out_of_range(std::string(key) + " is " + text::Shortest(value));
}

/// Reads a part of a recording; an exception becomes an error.
template <typename Value, typename Read>
Result<Value> Checked(const std::string& json, const std::string& part, const Read& read) {
  const auto parsed = text::ParseOrderedJson(json, part);
  if (!parsed) return parsed.error();
  try {
    return read(*parsed);
  } catch (const std::out_of_range& error) {
    return InvalidData(part + " is not as footing-ctl sway writes it: " + error.what());
  } catch (const ordered_json::exception& error) {
    return InvalidData(part + " is not as footing-ctl sway writes it: " +
                       std::string(text::WithoutTag(error.what())));
  }
}

Board BoardFromJson(const ordered_json& json) {
  constexpr double kFarthestM = 10;
  Board board;
  board.serial = json.at("serial").get<std::string>();
  board.role = stream::RoleNamed(json.at("role").get<std::string>());
  board.pose = {Between(json, "x_m", -kFarthestM, kFarthestM),
                Between(json, "y_m", -kFarthestM, kFarthestM),
                Between(json, "yaw_rad", -2 * kPi, 2 * kPi)};
  board.geometry = board::kBalanceBoard;
  board.geometry.sensor_distance_x_m =
      Between(json, "sensor_distance_x_m", board::kLeastLengthM, board::kMostLengthM);
  board.geometry.sensor_distance_y_m =
      Between(json, "sensor_distance_y_m", board::kLeastLengthM, board::kMostLengthM);
  return board;
}

Session SessionFromJson(const ordered_json& json) {
  constexpr double kMostHz = 1000, kMostS = 3600;
  Session session;
  session.subject = json.at("subject").get<std::string>();
  session.notes = json.at("notes").get<std::string>();
  session.wall_time_ns = json.at("wall_time_ns").get<std::int64_t>();
  for (const ordered_json& board : json.at("boards")) {
    session.boards.push_back(BoardFromJson(board));
  }
  if (session.boards.empty() || session.boards.size() > 2) {
    throw std::out_of_range("it has " + std::to_string(session.boards.size()) + " boards");
  }
  session.seconds = Between(json, "seconds", 0, kMostS);
  session.settle_s = Between(json, "settle_s", 0, kMostS);
  session.filter = {Between(json, "rate_hz", 0, kMostHz), Between(json, "cutoff_hz", 0, kMostHz),
                    Between(json, "window_s", 0, kMostS)};
  session.planned = json.at("planned").get<std::size_t>();
  session.program = json.at("program").get<std::string>();
  return session;
}

bool Counts(const Trial& trial) { return trial.rejected.empty() && trial.measures.has_value(); }

bool AnyTrial(const Session& session, bool (*is)(const Trial&)) {
  return std::any_of(session.trials.begin(), session.trials.end(),
                     [&](const Trial& trial) { return Counts(trial) && is(trial); });
}

std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

/// The fields of a trial that come before its measures, for JSON and CSV.
ordered_json Head(const Trial& trial) {
  const bool counts = Counts(trial);
  ordered_json head = ToJson(trial.condition);
  head["repeat"] = trial.repeat;
  head["attempt"] = trial.attempt;
  head["counts"] = counts;
  head["rejected"] = trial.rejected;
  head["from_ns"] = trial.from_ns;
  head["to_ns"] = trial.to_ns;
  head["mass_kg"] =
      OrNull(counts ? std::optional(NewtonsToKilograms(trial.weight_n)) : std::nullopt);
  head["left_load_percent"] =
      OrNull(trial.left_share ? std::optional(100 * *trial.left_share) : std::nullopt);
  head["recorded_rate_hz"] = trial.recorded_rate_hz;
  head["gaps"] = trial.gaps.count;
  return head;
}

}  // namespace

ordered_json PlanToJson(const Session& session) {
  ordered_json boards = ordered_json::array();
  for (const Board& board : session.boards) {
    boards.push_back({{"serial", board.serial},
                      {"role", stream::Name(board.role)},
                      {"x_m", board.pose.x_m},
                      {"y_m", board.pose.y_m},
                      {"yaw_rad", board.pose.yaw_rad},
                      {"sensor_distance_x_m", board.geometry.sensor_distance_x_m},
                      {"sensor_distance_y_m", board.geometry.sensor_distance_y_m}});
  }
  return {{"subject", session.subject},
          {"notes", session.notes},
          {"wall_time_ns", session.wall_time_ns},
          {"boards", std::move(boards)},
          {"seconds", session.seconds},
          {"settle_s", session.settle_s},
          {"rate_hz", session.filter.rate_hz},
          {"cutoff_hz", session.filter.cutoff_hz},
          {"window_s", session.filter.window_s},
          {"planned", session.planned},
          {"program", session.program}};
}

ordered_json TrialToJson(const Trial& trial) {
  ordered_json json = ToJson(trial.condition);
  json["repeat"] = trial.repeat;
  json["attempt"] = trial.attempt;
  json["from_ns"] = trial.from_ns;
  json["to_ns"] = trial.to_ns;
  json["rejected"] = trial.rejected;
  return json;
}

Result<Session> PlanFromJson(const std::string& json) {
  return Checked<Session>(json, "the metadata \"sway\"", SessionFromJson);
}

Result<Trial> TrialFromJson(const std::string& json) {
  return Checked<Trial>(json, "a record \"sway_trial\"", [](const ordered_json& parsed) {
    Trial trial;
    trial.condition = {OneOf(parsed, "eyes", kEyes), OneOf(parsed, "surface", kSurfaces),
                       OneOf(parsed, "feet", kFeet)};
    trial.repeat = parsed.at("repeat").get<int>();
    trial.attempt = parsed.at("attempt").get<int>();
    trial.from_ns = parsed.at("from_ns").get<std::int64_t>();
    trial.to_ns = parsed.at("to_ns").get<std::int64_t>();
    trial.rejected = parsed.at("rejected").get<std::string>();
    if (!IsInstant(trial.from_ns) || !IsInstant(trial.to_ns) || trial.to_ns < trial.from_ns) {
      throw std::out_of_range("it ends before it begins");
    }
    return trial;
  });
}

std::size_t Missing(const Session& session) {
  const auto counted =
      static_cast<std::size_t>(std::count_if(session.trials.begin(), session.trials.end(), Counts));
  return session.planned > counted ? session.planned - counted : 0;
}

std::vector<std::string> Warnings(const Session& session) {
  constexpr double kShortestS = 20;  // Scoppa et al. 2013 advise 25 to 40 s.
  std::vector<std::string> warnings;
  if (AnyTrial(session, [](const Trial& trial) { return trial.simulated; })) {
    warnings.emplace_back("simulated boards: these are not figures of a person");
  }
  if (AnyTrial(session, [](const Trial& trial) { return !trial.tared; })) {
    warnings.emplace_back("a board was not tared: its own weight is part of the loads");
  }
  if (AnyTrial(session, [](const Trial& trial) { return !trial.calibrated; })) {
    warnings.emplace_back("the calibration of a board was not read: its loads are approximate");
  }
  if (AnyTrial(session, [](const Trial& trial) { return trial.gaps.count > 0; })) {
    warnings.emplace_back("a trial has gaps without samples; nothing is measured across them");
  }
  if (session.filter.rate_hz <= 0) {
    warnings.emplace_back(
        "the COP is not filtered: noise and uneven sampling make the path longer");
  }
  if (session.seconds < kShortestS) {
    warnings.push_back("trials of " + text::Shortest(session.seconds) +
                       " s are too short to be compared with others: 25 to 40 s are usual");
  }
  if (const std::size_t missing = Missing(session); missing > 0) {
    warnings.push_back(std::to_string(missing) + " of " + std::to_string(session.planned) +
                       " trials are missing");
  }
  return warnings;
}

ordered_json ToJson(const Session& session) {
  ordered_json out = PlanToJson(session);
  out["date"] = text::Utc(session.wall_time_ns);
  out["recording"] = session.recording;
  out["filter"] = session.filter.Text();
  out["ellipse95_definition"] = posturography::kEllipseDefinition;
  out["spectrum_definition"] = posturography::kSpectrumDefinition;
  out["sample_entropy_definition"] = posturography::kEntropyDefinition;
  out["simulated"] = AnyTrial(session, [](const Trial& trial) { return trial.simulated; });
  out["tared"] = !AnyTrial(session, [](const Trial& trial) { return !trial.tared; });
  out["calibrated"] = !AnyTrial(session, [](const Trial& trial) { return !trial.calibrated; });
  out["missing"] = Missing(session);
  out["trials"] = ordered_json::array();
  for (const Trial& trial : session.trials) {
    ordered_json one = Head(trial);
    if (Counts(trial)) {
      for (const auto& measure : posturography::Named(*trial.measures)) {
        one[measure.key] = OrNull(measure.value);
      }
    }
    out["trials"].push_back(std::move(one));
  }
  const std::vector<Summary> summaries = Summaries(session.trials);
  out["conditions"] = ordered_json::array();
  for (const Summary& summary : summaries) {
    ordered_json one = ToJson(summary.condition);
    one["trials"] = summary.trials;
    for (const Averaged& measure : summary.measures) {
      one["mean"][measure.key] = OrNull(measure.mean);
      one["sd"][measure.key] = OrNull(measure.sd);
    }
    out["conditions"].push_back(std::move(one));
  }
  out["romberg"] = ordered_json::array();
  for (const Romberg& ratio : RombergRatios(summaries)) {
    out["romberg"].push_back({{"surface", ratio.surface},
                              {"feet", ratio.feet},
                              {"path_ratio", ratio.path},
                              {"ellipse95_ratio", ratio.ellipse95}});
  }
  out["warnings"] = Warnings(session);
  return out;
}

std::string ToCsv(const Session& session) {
  const auto measures = posturography::Named({});
  std::string csv = "subject,trial";
  const ordered_json names = Head({});
  for (const auto& [key, value] : names.items()) csv += "," + key;
  for (const auto& measure : measures) csv += std::string(",") + measure.key;
  csv += ",rate_hz,cutoff_hz,simulated,tared,calibrated\n";
  std::size_t number = 0;
  for (const Trial& trial : session.trials) {
    csv += Cell(session.subject) + "," + std::to_string(++number);
    const ordered_json head = Head(trial);
    for (const auto& [key, value] : head.items()) {
      csv += ",";
      if (!value.is_null())
        csv += value.is_string() ? Cell(value.get<std::string>()) : value.dump();
    }
    const auto own = Counts(trial) ? posturography::Named(*trial.measures) : measures;
    for (const auto& measure : own) {
      csv += ",";
      if (Counts(trial) && measure.value) text::AppendShortest(csv, *measure.value);
    }
    csv += "," + text::Shortest(session.filter.rate_hz) + "," +
           text::Shortest(session.filter.cutoff_hz) + (trial.simulated ? ",1" : ",0") +
           (trial.tared ? ",1" : ",0") + (trial.calibrated ? ",1\n" : ",0\n");
  }
  return csv;
}

std::string CopToCsv(const Session& session) {
  std::string csv = "trial,time_s,x_mm,y_mm\n";
  std::size_t number = 0;
  for (const Trial& trial : session.trials) {
    ++number;
    if (!Counts(trial)) continue;
    for (const auto& stretch : trial.cop) {
      for (const CopSample& sample : stretch) {
        csv += std::to_string(number) + ",";
        text::AppendShortest(csv, sample.time_s);
        csv += ",";
        text::AppendShortest(csv, sample.x_m * 1e3);
        csv += ",";
        text::AppendShortest(csv, sample.y_m * 1e3);
        csv += "\n";
      }
    }
  }
  return csv;
}

namespace {

/// A row of the report's table.
struct Shown {
  const char* key;
  const char* title;
  int decimals;
};
constexpr Shown kShown[] = {{"path_length_mm", "Path length, mm", 0},
                            {"mean_velocity_mm_s", "Mean velocity, mm/s", 1},
                            {"mean_velocity_ml_mm_s", "Mean velocity ML, mm/s", 1},
                            {"mean_velocity_ap_mm_s", "Mean velocity AP, mm/s", 1},
                            {"ellipse95_area_mm2", "95 % ellipse, mm\u00b2", 0},
                            {"rms_ml_mm", "RMS ML, mm", 2},
                            {"rms_ap_mm", "RMS AP, mm", 2},
                            {"range_ml_mm", "Range ML, mm", 1},
                            {"range_ap_mm", "Range AP, mm", 1},
                            {"median_frequency_ml_hz", "Median frequency ML, Hz", 2},
                            {"median_frequency_ap_hz", "Median frequency AP, Hz", 2},
                            {"frequency95_ml_hz", "95 % of power below, ML, Hz", 2},
                            {"frequency95_ap_hz", "95 % of power below, AP, Hz", 2},
                            {"sample_entropy_ml", "Sample entropy ML", 2},
                            {"sample_entropy_ap", "Sample entropy AP", 2}};

const Averaged* Find(const Summary& summary, std::string_view key) {
  for (const Averaged& one : summary.measures) {
    if (one.key == key) return &one;
  }
  return nullptr;
}

/// "312 (14)"; a dash where there is nothing.
std::string Text(const Averaged* measure, int decimals) {
  if (measure == nullptr || !measure->mean) return "\u2013";
  std::string text = text::Fixed(*measure->mean, decimals);
  if (measure->sd) text += " (" + text::Fixed(*measure->sd, decimals) + ")";
  return text;
}

std::string Capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

std::string FilterSentence(const Session& session) {
  const posturography::CopFilter& filter = session.filter;
  if (filter.rate_hz <= 0) return "as recorded, not filtered";
  std::string sentence = filter.Text() + ": " + text::Shortest(filter.rate_hz) + " Hz";
  if (filter.cutoff_hz > 0) sentence += ", cutoff " + text::Shortest(filter.cutoff_hz) + " Hz";
  return sentence;
}

std::string BoardsSentence(const Session& session) {
  std::vector<std::string> names;
  for (const Board& board : session.boards) names.push_back(Name(board) + " " + board.serial);
  return text::Joined(names);
}

}  // namespace

std::string ToText(const Session& session) {
  const std::vector<Summary> summaries = Summaries(session.trials);
  std::string text = session.subject + ", " + text::Utc(session.wall_time_ns);
  for (const Summary& summary : summaries) {
    text += "\n" + Title(summary.condition) + ", " + std::to_string(summary.trials) +
            (summary.trials == 1 ? " trial" : " trials, mean (SD)");
    for (const Shown& row : kShown) {
      text += std::string("\n  ") + row.title + ": " + Text(Find(summary, row.key), row.decimals);
    }
  }
  for (const Romberg& ratio : RombergRatios(summaries)) {
    text += "\nRomberg ratio, " + Title({"closed / open", ratio.surface, ratio.feet}) + ": path " +
            text::Fixed(ratio.path, 2) + ", ellipse " + text::Fixed(ratio.ellipse95, 2);
  }
  text += "\nCOP: " + FilterSentence(session);
  for (const std::string& warning : Warnings(session)) text += "\nwarning: " + warning;
  return text;
}

namespace {

// Sizes of pictures, mm of the page.
constexpr double kSideWide = 50, kSideMiddle = 42, kSideNarrow = 27;
constexpr double kAxisMm = 7, kTopMm = 4, kPlotWideMm = 132, kPlotMm = 46;
constexpr double kFontMm = 2.5;
constexpr const char* kFont = "font-size='2.5'";
constexpr const char* kThin = "stroke-width='0.12'";
constexpr const char* kMl = plot::kColours[0];
constexpr const char* kAp = plot::kColours[1];

/// One trial about its mean position, mm.
struct Curve {
  const Trial* trial = nullptr;
  double mean_x_mm = 0, mean_y_mm = 0;

  explicit Curve(const Trial& one) : trial(&one) {
    std::size_t count = 0;
    for (const auto& stretch : one.cop) {
      for (const CopSample& sample : stretch) {
        mean_x_mm += sample.x_m * 1e3;
        mean_y_mm += sample.y_m * 1e3;
        ++count;
      }
    }
    mean_x_mm /= static_cast<double>(count);
    mean_y_mm /= static_cast<double>(count);
  }
  double X(const CopSample& sample) const { return sample.x_m * 1e3 - mean_x_mm; }
  double Y(const CopSample& sample) const { return sample.y_m * 1e3 - mean_y_mm; }
  double Reach() const {
    double reach_mm = 0;
    for (const auto& stretch : trial->cop) {
      for (const CopSample& sample : stretch) {
        reach_mm = std::max({reach_mm, std::abs(X(sample)), std::abs(Y(sample))});
      }
    }
    return reach_mm;
  }
};

/// Marks of an axis from -reach to reach.
double MarkMm(double reach_mm) {
  for (const double mark_mm : {1, 2, 5, 10, 20, 50}) {
    if (reach_mm < 3 * mark_mm) return mark_mm;
  }
  return 100;
}

template <typename AtX, typename AtY>
std::string Polylines(const Curve& curve, const char* colour, const AtX& at_x, const AtY& at_y) {
  std::string svg;
  for (const auto& stretch : curve.trial->cop) {
    svg += std::string("<polyline fill='none' stroke='") + colour +
           "' stroke-width='0.22' stroke-linejoin='round' points='";
    for (const CopSample& sample : stretch) {
      text::AppendFixed(svg, at_x(sample), 2);
      svg += ",";
      text::AppendFixed(svg, at_y(sample), 2);
      svg += " ";
    }
    svg += "'/>\n";
  }
  return svg;
}

/// The area in which 95 % of the samples lie, by the prediction ellipse.
std::string Ellipse(const posturography::Sway& sway, double middle_x, double middle_y,
                    double scale) {
  const double product_m2 = kPi * sway.ellipse_axis_major_sd_m * sway.ellipse_axis_minor_sd_m;
  if (product_m2 <= 0) return "";
  const double factor = scale * 1e3 * std::sqrt(sway.ellipse95_prediction_m2 / product_m2);
  return "<ellipse cx='0' cy='0' rx='" + plot::Number(factor * sway.ellipse_axis_major_sd_m) +
         "' ry='" + plot::Number(factor * sway.ellipse_axis_minor_sd_m) +
         "' transform='translate(" + plot::Number(middle_x) + " " + plot::Number(middle_y) +
         ") rotate(" + plot::Number(-RadiansToDegrees(sway.ellipse_angle_rad)) +
         ")' fill='none' stroke='#222' stroke-width='0.3'/>\n";
}

/// An SVG of this size on the page.
std::string OpenMm(double width, double height) {
  std::string svg = plot::Open(width, height);
  return svg.insert(svg.find(" viewBox"), " style='width:" + plot::Number(width) + "mm;height:" +
                                              plot::Number(height) + "mm;overflow:visible'");
}

std::string Stabilogram(const Curve& curve, double reach_mm, double side) {
  const double plot_side = side - kAxisMm;
  const double scale = plot_side / 2 / reach_mm;
  const double middle_x = kAxisMm + plot_side / 2, middle_y = kTopMm / 2 + plot_side / 2;
  const double left = kAxisMm, right = side, top = middle_y - plot_side / 2,
               bottom = middle_y + plot_side / 2;
  std::string svg = OpenMm(side, side + kTopMm);
  const double mark_mm = MarkMm(reach_mm);
  const int marks = static_cast<int>(reach_mm / mark_mm);
  for (int i = -marks; i <= marks; ++i) {
    const double x = middle_x + i * mark_mm * scale, y = middle_y - i * mark_mm * scale;
    svg += plot::Line(x, top, x, bottom, i == 0 ? "#999" : "#ddd", kThin);
    svg += plot::Line(left, y, right, y, i == 0 ? "#999" : "#ddd", kThin);
    svg += plot::Label(x, bottom + kFontMm + 0.3, "middle", plot::Number(i * mark_mm), kFont);
    svg += plot::Label(left - 0.5, y + 0.8, "end", plot::Number(i * mark_mm), kFont);
  }
  svg += Polylines(
      curve, kMl, [&](const CopSample& sample) { return middle_x + scale * curve.X(sample); },
      [&](const CopSample& sample) { return middle_y - scale * curve.Y(sample); });
  svg += Ellipse(*curve.trial->measures, middle_x, middle_y, scale);
  svg += plot::Label(right, bottom + 2 * kFontMm + 0.6, "end", "ML, mm (right +)", kFont);
  svg += plot::Label(left + 0.6, top + kFontMm, "start", "AP, mm (front +)", kFont);
  return svg + "</svg>\n";
}

std::string OverTime(const Curve& curve, double reach_mm, double seconds, double width,
                     double side) {
  const double left = kAxisMm, right = width - 1, top = kTopMm / 2,
               bottom = kTopMm / 2 + side - kAxisMm;
  const double middle_y = (top + bottom) / 2, scale = (bottom - top) / 2 / reach_mm;
  const auto at_time = [&](double time_s) { return left + time_s / seconds * (right - left); };
  std::string svg = OpenMm(width, side + kTopMm);
  const double mark_mm = MarkMm(reach_mm);
  const int marks = static_cast<int>(reach_mm / mark_mm);
  for (int i = -marks; i <= marks; ++i) {
    const double y = middle_y - i * mark_mm * scale;
    svg += plot::Line(left, y, right, y, i == 0 ? "#999" : "#ddd", kThin);
    svg += plot::Label(left - 0.5, y + 0.8, "end", plot::Number(i * mark_mm), kFont);
  }
  const double mark_s = seconds > 30 ? 10 : seconds > 10 ? 5 : 1;
  for (int i = 0; i * mark_s <= seconds; ++i) {
    const double x = at_time(i * mark_s);
    svg += plot::Line(x, bottom, x, bottom + 0.7, "#999", kThin);
    svg += plot::Label(x, bottom + kFontMm + 0.7, "middle", plot::Number(i * mark_s), kFont);
  }
  const auto at_x = [&](const CopSample& sample) { return at_time(sample.time_s); };
  svg += Polylines(curve, kMl, at_x,
                   [&](const CopSample& sample) { return middle_y - scale * curve.X(sample); });
  svg += Polylines(curve, kAp, at_x,
                   [&](const CopSample& sample) { return middle_y - scale * curve.Y(sample); });
  svg += plot::Label(right, bottom + 2 * kFontMm + 0.6, "end", "time, s", kFont);
  const std::string colour = std::string(kFont) + " style='fill:";
  svg += plot::Label(left + 0.6, top + kFontMm, "start", "ML, mm", colour + kMl + "'");
  svg += plot::Label(left + 12, top + kFontMm, "start", "AP, mm", colour + kAp + "'");
  return svg + "</svg>\n";
}

/// The first trial of each condition, all to one scale.
std::string Figures(const Session& session, const std::vector<Summary>& summaries) {
  std::vector<Curve> curves;
  for (const Summary& summary : summaries) {
    const auto first = std::find_if(
        session.trials.begin(), session.trials.end(),
        [&](const Trial& trial) { return Counts(trial) && trial.condition == summary.condition; });
    curves.emplace_back(*first);
  }
  double reach_mm = 1;
  for (const Curve& curve : curves) reach_mm = std::max(reach_mm, 1.05 * curve.Reach());
  const bool wide = curves.size() <= 2;
  const double side = wide ? kSideWide : curves.size() <= 4 ? kSideMiddle : kSideNarrow;
  const double width = wide ? kPlotWideMm : kPlotMm + kSideMiddle - side;
  std::string html = std::string("<div class='figures ") + (wide ? "one" : "two") + "'>";
  for (const Curve& curve : curves) {
    html += "<figure><figcaption>" + plot::Escaped(Capitalised(Title(curve.trial->condition))) +
            ", trial " + std::to_string(curve.trial->repeat) + "</figcaption><div>" +
            Stabilogram(curve, reach_mm, side) +
            OverTime(curve, reach_mm, session.seconds, width, side) + "</div></figure>";
  }
  return html + "</div>";
}

std::string MeasureTable(const std::vector<Summary>& summaries) {
  std::string html = "<table><tr><th>Mean (SD) of the trials that count</th>";
  for (const Summary& summary : summaries) {
    html += "<th>" + plot::Escaped(Capitalised(Title(summary.condition))) +
            "<br>n = " + std::to_string(summary.trials) + "</th>";
  }
  html += "</tr>";
  for (const Shown& row : kShown) {
    html += std::string("<tr><td>") + row.title + "</td>";
    for (const Summary& summary : summaries) {
      html += "<td>" + Text(Find(summary, row.key), row.decimals) + "</td>";
    }
    html += "</tr>";
  }
  return html + "</table>";
}

std::string RombergTable(const std::vector<Summary>& summaries) {
  const std::vector<Romberg> ratios = RombergRatios(summaries);
  if (ratios.empty()) return "";
  std::string html =
      "<table><tr><th>Romberg ratio, eyes closed / open</th><th>Path length, mean velocity</th>"
      "<th>95 % ellipse</th></tr>";
  for (const Romberg& ratio : ratios) {
    const std::string title = Title({"", ratio.surface, ratio.feet});
    html += "<tr><td>" + plot::Escaped(Capitalised(title.substr(title.find(", ") + 2))) +
            "</td><td>" + text::Fixed(ratio.path, 2) + "</td><td>" +
            text::Fixed(ratio.ellipse95, 2) + "</td></tr>";
  }
  return html + "</table>";
}

constexpr const char* kStyle =
    "@page{size:A4;margin:10mm 12mm}body{font:9pt/1.3 sans-serif;color:#222;width:186mm;"
    "margin:6mm auto}@media print{body{margin:0}}h1{font-size:14pt;margin:0 0 1mm}"
    "p{margin:1mm 0}table{border-collapse:collapse;margin:2mm 0;width:100%;font-size:8pt}"
    "th,td{border-bottom:.2mm solid #ccc;padding:.2mm 1.5mm;text-align:right;font-weight:normal}"
    "th{border-bottom:.3mm solid #222;vertical-align:bottom}"
    "th:first-child,td:first-child{text-align:left}.warning{color:#a01c1c;font-weight:bold}"
    ".figures{display:grid;gap:1mm 2mm}.two{grid-template-columns:1fr 1fr}"
    "figure{margin:0;break-inside:avoid}figcaption{font-size:8pt}figure div{display:flex;gap:1mm}"
    ".small{font-size:7pt;color:#444}";

constexpr const char* kDefinitions =
    "ML: to the side, right is positive; AP: to the front. Path length: sum of the distances of "
    "consecutive values; mean velocity: path over time; RMS: about the mean position (Prieto et "
    "al. "
    "1996). 95 % ellipse: prediction ellipse (Schubert &amp; Kirchner 2014), drawn in the "
    "stabilograms. Frequencies: spectrum from 0.15 to 5 Hz, eight sine tapers (Prieto et al. "
    "1996). "
    "Sample entropy: m = 2, r = 0.2 RMS, at the rate above (Richman &amp; Moorman 2000). Compare "
    "only figures with the same rate, filter, duration and definitions. Not a medical device.";

}  // namespace

std::string ToHtml(const Session& session) {
  const std::vector<Summary> summaries = Summaries(session.trials);
  std::vector<double> weights_n;
  std::size_t rejected = 0;
  for (const Trial& trial : session.trials) {
    if (Counts(trial)) weights_n.push_back(trial.weight_n);
    if (!Counts(trial)) ++rejected;
  }
  std::string html =
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>Quiet standing: " +
      plot::Escaped(session.subject) + "</title><style>" + kStyle +
      "</style></head><body><h1>Quiet standing: " + plot::Escaped(session.subject) + "</h1><p>" +
      text::Utc(session.wall_time_ns) + "; " +
      text::Fixed(NewtonsToKilograms(text::Median(weights_n)), 1) + " kg; " +
      std::to_string(weights_n.size()) + " trials of " + text::Shortest(session.seconds) +
      " s after " + text::Shortest(session.settle_s) + " s of standing, " +
      std::to_string(rejected) + " attempts rejected</p><p>" +
      plot::Escaped(Capitalised(BoardsSentence(session))) +
      ". COP: " + plot::Escaped(FilterSentence(session)) + ".</p>";
  if (!session.notes.empty()) html += "<p>Notes: " + plot::Escaped(session.notes) + "</p>";
  const std::vector<std::string> warnings = Warnings(session);
  if (!warnings.empty()) {
    html +=
        "<p class='warning'>" + plot::Escaped(Capitalised(text::Joined(warnings, "; "))) + ".</p>";
  }
  if (!summaries.empty()) {
    html += MeasureTable(summaries) + RombergTable(summaries) + Figures(session, summaries);
  }
  return html + "<p class='small'>" + kDefinitions + " " + plot::Escaped(session.program) + "; " +
         plot::Escaped(session.recording) + "</p></body></html>\n";
}

}  // namespace footing::sway
