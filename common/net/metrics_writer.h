#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "common/net/process_usage.h"
#include "common/net/prometheus.h"

namespace footing::monitoring {

struct Label {
  const char* name;
  std::string value;
};

/// Labels of a sample: {name="value",...}.
std::string Braced(std::initializer_list<Label> labels);

/// Writes metrics in Prometheus' text format 0.0.4: a line # HELP and # TYPE each, then samples.
class MetricsWriter {
 public:
  /// Begins a metric; its samples follow. Base units; the name of a counter ends in _total.
  void Gauge(const char* name, const char* help) { Begin(name, help, "gauge"); }
  void Counter(const char* name, const char* help) { Begin(name, help, "counter"); }

  /// What is not finite is written as 0.
  void Sample(double value, const std::string& labels = "");
  void Sample(std::uint64_t value, const std::string& labels = "");

  std::string Take();

 private:
  void Begin(const char* name, const char* help, const char* type);

  std::string name_;
  std::string text_;
};

/// footing_build_info, and process_* as other programs have them.
void WriteProgram(const Program& program, MetricsWriter& to);
void WriteProcess(const ProcessUsage& usage, MetricsWriter& to);

}  // namespace footing::monitoring
