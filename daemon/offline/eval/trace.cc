#include "daemon/offline/eval/trace.h"

#include <cerrno>
#include <system_error>

#include "common/base/units.h"

namespace footing::eval {
namespace {

constexpr const char* kColumns =
    "seed,time,place,aside,heading_error,speed,wanted,meant,commanded,runs,phase,"
    "commanded_speed,wanted_turn,commanded_turn,failures,next,frequency,phase_between,"
    "elevation,turn_share\n"
    ",s,m,m,deg,m/s,,,,,,m/s,deg,deg,,,Hz,deg,deg,1\n";

}  // namespace

Result<TrackTrace> TrackTrace::Create(const std::string& path) {
  TrackTrace trace;
  if (path.empty()) return trace;
  trace.path_ = path;
  trace.file_.open(path);
  trace.file_ << kColumns;
  if (!trace.file_.flush()) return trace.CannotWrite();
  return trace;
}

Error TrackTrace::CannotWrite() const {
  return Failure("cannot write " + path_ + ": " +
                 std::generic_category().message(error_ != 0 ? error_ : errno) +
                 "; name another file");
}

Result<void> TrackTrace::Flush() {
  if (!file_.is_open() || file_.flush()) return {};
  return CannotWrite();
}

void TrackTrace::Add(stream::Gait wanted, stream::Gait meant, double turn_rad,
                     const engine::EngineOutput& output) {
  if (!file_.is_open()) return;
  const stream::GaitState& gait = output.gait;
  const stream::InterfaceState& shown = output.interface;
  const auto degrees = [](double angle_rad) { return RadiansToDegrees(angle_rad); };
  file_ << seed_ << ',' << output.time_s << ',' << output.trial.distance_m << ','
        << output.trial.lateral_offset_m << ',' << degrees(output.trial.heading_error_rad) << ','
        << gait.speed_mps << ',' << stream::Name(wanted) << ',' << stream::Name(meant) << ','
        << stream::Name(gait.commanded_gait) << ',' << stream::Name(gait.gait) << ',' << gait.phase
        << ',' << gait.commanded_speed_mps << ',' << degrees(turn_rad) << ','
        << degrees(gait.commanded_turn_rad) << ',' << gait.falls << ','
        << stream::Name(shown.next_gait) << ',';
  if (shown.frequency_valid) file_ << shown.frequency_hz;
  file_ << ',';
  if (shown.phase_valid) file_ << degrees(shown.phase_rad);
  file_ << ',';
  if (shown.forearms.valid) file_ << degrees(shown.forearms.elevation_rad);
  file_ << ',';
  if (shown.turn.valid) file_ << shown.turn.share;
  file_ << '\n';
  if (!file_ && error_ == 0) error_ = errno;
}

}  // namespace footing::eval
