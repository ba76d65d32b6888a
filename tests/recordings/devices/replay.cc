#include "tests/recordings/devices/replay.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "daemon/sensor/service/hub.h"

namespace footing::recordings {
namespace {

constexpr std::int64_t kStartNs = 1'000'000'000;
constexpr std::int64_t kTickNs = 10'000'000;

template <typename T>
void Append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void Append(sensor::TickContent& to, sensor::TickContent&& from) {
  Append(to.motion, from.motion);
  Append(to.boards, from.boards);
  Append(to.nunchuks, from.nunchuks);
  Append(to.cameras, from.cameras);
  if (from.has_status) to.status = std::move(from.status);
}

std::string Line(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string Line(const char* format, ...) {
  char line[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  return line;
}

double Milliseconds(std::int64_t at_ns) { return static_cast<double>(at_ns - kStartNs) * 1e-6; }

/// No "-0.0000": the sign of nothing is nobody's business.
double Rounded(double value) { return std::abs(value) < 5e-5 ? 0 : value; }

std::string Print(const stream::DeviceStatus& s) {
  std::string text =
      Line("status kind=%s state=%s extension=%s", Name(s.kind), Name(s.state), Name(s.extension));
  text += Line(" calibration=%s extension_calibration=%s gyroscope_calibration=%s",
               Name(s.calibration), Name(s.extension_calibration), Name(s.gyroscope_calibration));
  text += Line(" battery=%.3f clipped=%llu undecodable=%llu note=\"%s\"\n", s.battery_fraction,
               static_cast<unsigned long long>(s.clipped),
               static_cast<unsigned long long>(s.undecodable), s.note.c_str());
  return text;
}

std::string Print(const stream::MotionSample& s) {
  const auto& f = s.specific_force_mps2;
  std::string text = Line("motion %.3f force %.4f %.4f %.4f clipped %u repeated %d uncalibrated %d",
                          Milliseconds(s.received_ns), Rounded(f.x()), Rounded(f.y()),
                          Rounded(f.z()), s.clipped_axes, s.repeated, s.uncalibrated);
  text += Line(" buttons %x", s.buttons);
  if (s.has_angular_velocity) {
    const auto& w = s.angular_velocity_radps;
    text += Line(" velocity %.4f %.4f %.4f uncalibrated %d", Rounded(w.x()), Rounded(w.y()),
                 Rounded(w.z()), s.gyroscope_uncalibrated);
  }
  if (s.has_magnetic_field) {
    const auto& m = s.magnetic_field;
    text += Line(" magnetic %.0f %.0f %.0f trigger %.3f celsius %.1f", m.x(), m.y(), m.z(),
                 s.trigger, s.temperature_c);
  }
  return text + "\n";
}

std::string Print(const stream::BoardSample& s) {
  std::string text = Line("board %.3f newtons %.3f %.3f %.3f %.3f", Milliseconds(s.received_ns),
                          s.top_left_n, s.top_right_n, s.bottom_left_n, s.bottom_right_n);
  if (s.cop_valid) text += Line(" cop %.4f %.4f", Rounded(s.cop_x_m), Rounded(s.cop_y_m));
  return text + Line(" repeated %d uncalibrated %d\n", s.repeated, s.uncalibrated);
}

std::string Print(const stream::NunchukSample& s) {
  const auto& f = s.specific_force_mps2;
  return Line("nunchuk %.3f stick %.4f %.4f c %d z %d force %.4f %.4f %.4f uncalibrated %d\n",
              Milliseconds(s.received_ns), Rounded(s.stick_x), Rounded(s.stick_y), s.c, s.z,
              Rounded(f.x()), Rounded(f.y()), Rounded(f.z()), s.uncalibrated);
}

std::string Print(const stream::CameraSample& s) {
  std::string text = Line("camera %.3f", Milliseconds(s.received_ns));
  for (const auto& point : s.points) text += Line(" %u,%u,%u", point.x, point.y, point.size);
  return text + "\n";
}

}  // namespace

Result<sensor::TickContent> Replay(const Capture& capture) {
  const auto identity = IdentityOf(capture);
  if (!identity) return identity.error();
  sensor::Config config;
  config.camera = capture.Header("Camera") == "on";
  std::int64_t now_ns = kStartNs;
  sensor::Hub hub(config, {[](devices::DeviceHandle, const reports::OutputReport&) {},
                           [](const sensor::LogLine&) {}, [&now_ns] { return now_ns; },
                           [](devices::DeviceHandle, std::uint8_t, std::size_t) {}});
  constexpr devices::DeviceHandle kHandle = 1;
  hub.OnAttach(kHandle, identity.value());
  sensor::TickContent content;
  std::int64_t tick_ns = kStartNs;
  const auto tick_until = [&](std::int64_t until_ns) {
    for (; tick_ns + kTickNs < until_ns; now_ns = tick_ns) {
      tick_ns += kTickNs;
      Append(content, hub.Tick(tick_ns));
    }
  };
  for (const CapturedReport& report : capture.reports) {
    if (report.to_device) continue;
    const std::int64_t at_ns = kStartNs + report.at_ns;
    tick_until(at_ns);
    now_ns = at_ns;
    devices::IncomingReport incoming;
    incoming.received_ns = at_ns;
    incoming.bytes = report.bytes;
    incoming.feature = report.feature;
    hub.OnReport(kHandle, incoming);
  }
  tick_until(now_ns + kTickNs + 1);
  return content;
}

std::string Print(const sensor::TickContent& content) {
  std::string text;
  for (const auto& status : content.status) text += Print(status);
  for (const auto& sample : content.motion) text += Print(sample);
  for (const auto& sample : content.boards) text += Print(sample);
  for (const auto& sample : content.nunchuks) text += Print(sample);
  for (const auto& sample : content.cameras) text += Print(sample);
  return text;
}

}  // namespace footing::recordings
