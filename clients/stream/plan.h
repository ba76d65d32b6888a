#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "clients/stream/simulated_device.h"
#include "common/base/result.h"
#include "common/stream/contacts.h"
#include "common/stream/hands.h"
#include "common/virtual/devices/accelerometer.h"

namespace footing::stream_client {

/// Values of the common flags.
struct Common {
  std::string to;  ///< Empty: footingd's default device socket.
  std::uint64_t seed = 1;
  std::string link = "good";
  double rate_scale = 1;
  double seconds = 0;  ///< 0: the script again and again, a recording once.
};

/// Devices that a synthetic user holds.
enum class HeldKind { kWiimote, kJoycon };
/// "wiimote" or "joycon"; else a usage error that lists them.
Result<HeldKind> HeldKindNamed(const std::string& name);

/// The same, and what is plugged into a Wiimote's port.
struct Held {
  HeldKind kind = HeldKind::kWiimote;
  bool motion_plus = false;
  bool nunchuk = false;
};

/// Colours of the spheres that the plan's devices show, 0xRRGGBB.
using SphereLights = std::map<stream::DeviceRole, std::uint32_t>;

/// Frames sent at a fixed rate, not measured by a device. One of the functions is set; times are
/// seconds since the start of the motion and increase. A copy starts from the beginning.
struct Feed {
  double rate_hz = 60;
  double late_s = 0;  ///< Delay between a frame's time and its sending.
  std::function<stream::HandFrame(double t_s)> hands;
  std::function<stream::ReferenceFrame(double t_s)> reference;
  std::function<stream::ContactFrame(double t_s)> contacts;
  /// Sends by itself, to another program, what is exposed at this instant of the host's clock.
  std::function<void(double t_s, std::int64_t exposed_ns, const SphereLights& lights)> frames;
};

/// A device of the plan that is out of reach for a while, seconds since the motion began: nothing
/// comes from it and nothing gets to it.
struct Silence {
  std::size_t device = 0;
  double from_s = 0, to_s = 0;
  bool Covers(double t_s) const { return t_s >= from_s && t_s < to_s; }
};

/// Simulated devices and the duration of their motion (0: endless).
struct Plan {
  std::vector<SimulatedDevice> devices;
  std::vector<Feed> feeds;
  std::vector<Silence> silences;
  double duration_s = 0;
};

/// A synthetic user; `script` is a built-in name or a path. `interface` "wrist": two Wiimotes that
/// are swung. "joystick": one Wiimote in the right hand, whose Nunchuk's stick walks, runs and
/// turns, and whose button A jumps (gait paper, section 7), or a Joy-Con with its own stick. A
/// MotionPlus measures the rate of inclination.
Result<Plan> PlanUser(const std::string& script, const std::string& interface, const Common& common,
                      const Held& held = {});

/// One or two Wiimotes that feel recorded accelerations: CSV `ax,ay,az`, m/s² in the sensor frame.
Result<Plan> PlanAccelerations(const std::string& left, const std::string& right, double rate_hz,
                               const Common& common);

/// One or two boards that feel recorded corners: CSV `time_s,tl_kg,tr_kg,bl_kg,br_kg`.
Result<Plan> PlanCorners(const std::string& left, const std::string& right, const Common& common);

/// Parts of every plan: the link that a flag names, seeds so that no two devices of a run share
/// their random numbers, a Wiimote with the extension in its port or a Joy-Con, the right one for
/// the right hand and leg. The noise of a Wiimote's sensor is part of its motion; a Joy-Con's is
/// added.
Result<virtual_devices::LinkQuality> ParseLink(const std::string& name);
std::uint64_t DeviceSeed(const Common& common, std::uint64_t device);
SimulatedDevice MakeRemote(const Common& common, virtual_devices::LinkQuality link,
                           std::uint64_t device, stream::DeviceRole role,
                           SimulatedDevice::WiimoteMotion motion, const Held& held = {});

/// A CSV table of numbers with a fixed number of columns; the first line may be a header.
struct Table {
  std::vector<std::vector<double>> rows;
};

/// Parses it. Errors name `origin`, the line and what is wrong with it: a column too few or too
/// many, a text that is not a finite number.
Result<Table> ParseTable(const std::string& text, std::size_t columns, const std::string& origin);

/// Input of a user of the joystick interface: a Nunchuk's stick and a Wiimote's button.
struct StickState {
  double x = 0;  ///< -1 left to 1 right.
  double y = 0;  ///< -1 back to 1 front.
  bool jump = false;
};

/// The script of the wrists, performed with stick and button (gait paper, section 7, "Joystick
/// Interface" and figure 11): inside a radius of 0.6 of 1.0 the character walks, outside it runs;
/// to the side it turns; a button makes it jump. Hands that swing in phase become one press a
/// cycle, an inclination to the right (left side up) the stick pushed to the right.
class StickMotion {
 public:
  /// The stick needs `blend_s` to get to its new place. `segments` not empty.
  StickMotion(std::vector<wrists::Segment> segments, double blend_s);

  /// State at t_s since the start; before it the first instant, after the end the last segment goes
  /// on.
  StickState At(double t_s) const;
  double DurationSeconds() const { return duration_s_; }

 private:
  std::vector<wrists::Segment> segments_;
  double blend_s_;
  double duration_s_ = 0;
};

/// How a synthetic player holds the Wiimote with which the terrain game's track is built.
struct BuilderGrip {
  double roll_rad = 0;   ///< Left side higher is positive: a curve to the right.
  double pitch_rad = 0;  ///< Front higher is positive: up.
  bool a = false;        ///< A step in place of a slope.
  bool b = false;        ///< A pit.
};

/// A seeded sequence of grips: slopes, curves and steps to both sides, pits if wanted, and level
/// ground, each held for 1 to 1.8 s at an inclination of 15 to 45 degrees. Every one of them comes
/// once before any comes again.
class BuilderScript {
 public:
  BuilderScript(std::uint64_t seed, bool pits);

  /// Grip at t_s since the start; it changes over in 0.25 s. Without end: it begins again.
  BuilderGrip At(double t_s) const;
  double duration_s() const { return duration_s_; }

 private:
  struct Stretch {
    double from_s = 0;
    BuilderGrip grip;
  };
  std::vector<Stretch> stretches_;
  double duration_s_ = 0;
};

/// One Wiimote in the role editor.
Result<Plan> PlanBuilder(bool pits, const Common& common);

/// The devices of a recording of footingd, from their first report to their last. InvalidData when
/// it holds no raw report; a device whose handshake was not recorded is named in the log.
Result<Plan> PlanReplay(const std::string& path, const Common& common);

}  // namespace footing::stream_client
