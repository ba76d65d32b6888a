#include "clients/study/report/latency.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "clients/study/report/figure.h"
#include "common/statistics/quantile.h"
#include "common/stream/response.h"
#include "common/base/number.h"

namespace footing::study::report {
namespace {

using records::StageTime;

/// As stream::ResponseTimes names it.
constexpr const char* kCommandStage = "command";

// Pixels.
constexpr double kBarHeight = 22, kRowHeight = 34, kBarLeft = 80, kBarsWidth = 560, kLegend = 26,
                 kKey = 10;
/// Of the stages, in their order.
constexpr std::array kColours{"#1f5fa8", "#5b93c9", "#9dbfe0", "#3d8b37", "#d9d9d9", "#c2571a"};

std::string Rectangle(double x, double y, double width, double height, const char* colour,
                      const std::string& title) {
  return "<rect class=\"bar\" x=\"" + text::Fixed(x, 1) + "\" y=\"" + text::Fixed(y, 1) +
         "\" width=\"" + text::Fixed(width, 1) + "\" height=\"" + text::Fixed(height, 0) +
         "\" style=\"fill:" + colour + "\"><title>" + Escaped(title) + "</title></rect>";
}

double WholeMs(const records::Response& response) {
  double sum_ms = 0;
  for (const StageTime& one : response) sum_ms += one.ms;
  return sum_ms;
}

/// Of one stage; 0 where there is none.
double MsOf(const records::Response& response, const std::string& stage) {
  double ms = 0;
  for (const StageTime& one : response) ms += one.stage == stage ? one.ms : 0;
  return ms;
}

struct Bars {
  std::vector<std::string> interfaces;
  std::vector<std::string> stages;
  std::map<std::string, double> length_ms;  ///< By interface: the sum of the stages' medians.
  std::map<std::string, double> whole_ms;   ///< By interface.
};

Bars BarsOf(const std::vector<StageLatency>& latency) {
  Bars bars;
  const auto add = [](std::vector<std::string>& list, const std::string& one) {
    if (std::find(list.begin(), list.end(), one) == list.end()) list.push_back(one);
  };
  for (const StageLatency& one : latency) {
    if (one.stage == kWhole) bars.whole_ms[one.interface] = one.p50_ms;
    if (!IsBar(one)) continue;
    add(bars.interfaces, one.interface);
    add(bars.stages, one.stage);
    bars.length_ms[one.interface] += one.p50_ms;
  }
  return bars;
}

}  // namespace

bool IsBar(const StageLatency& latency) {
  return latency.stage != kWithoutContact && latency.stage != kWithoutWindow &&
         latency.stage != kWhole;
}

double WithoutContactMs(const records::Response& response) {
  return WholeMs(response) - MsOf(response, stream::kContactStage);
}

double WithoutWindowMs(const records::Response& response) {
  return WithoutContactMs(response) - MsOf(response, kCommandStage);
}

std::vector<StageLatency> LatencyByStage(const std::vector<std::string>& interfaces,
                                         const std::vector<records::Records>& people) {
  std::vector<StageLatency> latency;
  for (const std::string& interface : interfaces) {
    std::vector<std::pair<std::string, std::vector<double>>> stages;
    const auto add = [&stages](const std::string& stage, double ms) {
      const auto found = std::find_if(stages.begin(), stages.end(),
                                      [&](const auto& one) { return one.first == stage; });
      (found == stages.end() ? stages.emplace_back(stage, std::vector<double>()) : *found)
          .second.push_back(ms);
    };
    for (const records::Records& person : people) {
      if (person.withdrawn) continue;
      for (const records::Trial* trial : records::Counting(person)) {
        if (trial->interface != interface) continue;
        for (const records::Response& response : trial->responses) {
          for (const StageTime& one : response) add(one.stage, one.ms);
          add(kWithoutContact, WithoutContactMs(response));
          add(kWithoutWindow, WithoutWindowMs(response));
          add(kWhole, WholeMs(response));
        }
      }
    }
    for (const auto& [stage, times_ms] : stages) {
      latency.push_back({interface, stage, times_ms.size(), statistics::MedianOf(times_ms),
                         statistics::QuantileOf(times_ms, 0.95)});
    }
  }
  return latency;
}

std::string LatencyFigure(const std::vector<StageLatency>& latency) {
  const Bars bars = BarsOf(latency);
  double greatest_ms = 0;
  for (const auto& [interface, length_ms] : bars.length_ms) {
    greatest_ms = std::max(greatest_ms, length_ms);
  }
  if (greatest_ms <= 0) return "";
  const double scale = kBarsWidth / greatest_ms;
  const double height = kLegend + kRowHeight * static_cast<double>(bars.interfaces.size());
  std::string svg = OpenSvg(kBarLeft + kBarsWidth + 60, height, "Median latency by stage");
  const auto colour = [&](std::size_t stage) { return kColours[stage % kColours.size()]; };
  for (std::size_t i = 0; i < bars.stages.size(); ++i) {
    const double x = kBarLeft + 95 * static_cast<double>(i);
    svg += Rectangle(x, 4, kKey, kKey, colour(i), "") + Label(x + 14, 13, "start", bars.stages[i]);
  }
  for (std::size_t row = 0; row < bars.interfaces.size(); ++row) {
    const double y = kLegend + kRowHeight * static_cast<double>(row);
    double x = kBarLeft;
    svg += Label(kBarLeft - 8, y + 15, "end", bars.interfaces[row]);
    for (const StageLatency& one : latency) {
      if (one.interface != bars.interfaces[row] || !IsBar(one)) continue;
      const auto stage = std::find(bars.stages.begin(), bars.stages.end(), one.stage);
      svg += Rectangle(x, y, one.p50_ms * scale, kBarHeight,
                       colour(static_cast<std::size_t>(stage - bars.stages.begin())),
                       one.stage + " " + text::Fixed(one.p50_ms, 1) + " ms");
      x += one.p50_ms * scale;
    }
    svg += Label(x + 6, y + 15, "start",
                 text::Fixed(bars.whole_ms.at(bars.interfaces[row]), 0) + " ms");
  }
  return svg + "</svg>";
}

}  // namespace footing::study::report
