#include "common/net/metrics_writer.h"

#include <cmath>
#include <utility>

#include "common/base/number.h"

namespace footing::monitoring {
namespace {

/// As the format wants a label's value: a backslash, a quote and the end of a line are escaped.
std::string Escaped(const std::string& value) {
  std::string text;
  for (const char c : value) {
    if (c == '\\' || c == '"') text += '\\';
    text += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return text;
}

}  // namespace

std::string Braced(std::initializer_list<Label> labels) {
  std::string text;
  for (const Label& label : labels) {
    text +=
        (text.empty() ? "{" : ",") + std::string(label.name) + "=\"" + Escaped(label.value) + "\"";
  }
  return text + "}";
}

void MetricsWriter::Sample(double value, const std::string& labels) {
  text_ += name_ + labels + ' ';
  text::AppendShortest(text_, std::isfinite(value) ? value : 0);
  text_ += '\n';
}

void MetricsWriter::Sample(std::uint64_t value, const std::string& labels) {
  text_ += name_ + labels + ' ' + std::to_string(value) + '\n';
}

std::string MetricsWriter::Take() { return std::exchange(text_, {}); }

void MetricsWriter::Begin(const char* name, const char* help, const char* type) {
  name_ = name;
  text_ += "# HELP " + name_ + ' ' + help + "\n# TYPE " + name_ + ' ' + type + '\n';
}

void WriteProgram(const Program& program, MetricsWriter& to) {
  to.Gauge("footing_build_info", "1; the labels say which program this is.");
  to.Sample(std::uint64_t{1}, Braced({{"program", program.name}, {"version", program.version}}));
}

void WriteProcess(const ProcessUsage& usage, MetricsWriter& to) {
  to.Counter("process_cpu_seconds_total", "CPU time of the process, user and system.");
  to.Sample(usage.cpu_s);
  to.Gauge("process_resident_memory_bytes", "Resident memory of the process.");
  to.Sample(usage.resident_bytes);
  to.Gauge("process_open_fds", "Open file descriptors of the process.");
  to.Sample(usage.open_descriptors);
}

}  // namespace footing::monitoring
