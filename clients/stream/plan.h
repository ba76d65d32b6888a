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

namespace footing::stream_client {

/// What the common flags say.
struct Common {
  std::string to;  ///< Empty: footingd's default device socket.
  std::uint64_t seed = 1;
  std::string link = "good";
  double rate_scale = 1;
  double seconds = 0;  ///< 0: the script again and again, a recording once.
};

/// What is in the Wiimotes' ports.
struct Ports {
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
/// turns, and whose button A jumps (gait paper, section 7). A MotionPlus measures the rate of
/// inclination.
Result<Plan> PlanUser(const std::string& script, const std::string& interface, const Common& common,
                      const Ports& ports = {});

/// One or two Wiimotes that feel recorded accelerations: CSV `ax,ay,az`, m/s² in the sensor frame.
Result<Plan> PlanAccelerations(const std::string& left, const std::string& right, double rate_hz,
                               const Common& common);

/// One or two boards that feel recorded corners: CSV `time_s,tl_kg,tr_kg,bl_kg,br_kg`.
Result<Plan> PlanCorners(const std::string& left, const std::string& right, const Common& common);

/// What every plan is made with: the link that a flag names, seeds so that no two devices of a run
/// share their random numbers, a Wiimote with what is in its port.
Result<virtual_devices::LinkQuality> ParseLink(const std::string& name);
std::uint64_t DeviceSeed(const Common& common, std::uint64_t device);
SimulatedDevice MakeWiimote(const Common& common, virtual_devices::LinkQuality link,
                            std::uint64_t device, stream::DeviceRole role,
                            SimulatedDevice::WiimoteMotion motion, const Ports& ports = {});

}  // namespace footing::stream_client
