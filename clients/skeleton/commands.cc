#include "clients/skeleton/commands.h"

#include <cmath>
#include <iostream>
#include <memory>

#include "clients/skeleton/receiver.h"
#include "clients/skeleton/sender.h"
#include "clients/skeleton/tracking/synthetic_clip.h"
#include "common/base/json_text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/net/address.h"
#include "common/net/device_link.h"
#include "common/net/socket.h"
#include "common/net/udp.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"

namespace footing::skeleton {
namespace {

constexpr std::size_t kMostClipBytes = std::size_t{256} << 20;  // Three hours at 30 Hz.

/// Values of --units, --factor, --offset, --flip-y, --mirrored and --swap-sides.
struct DialectFlags {
  std::string units = "dialect";
  std::vector<double> factor{1, 1, 1}, offset{0, 0, 0};
  bool flip_y = false, mirrored = false, swap_sides = false;

  void Add(CLI::App& app) {
    app.add_option("--units", units,
                   "Units of the sender's numbers: dialect, normalised, mm, cm or m")
        ->check(CLI::IsMember({"dialect", "normalised", "mm", "cm", "m"}));
    app.add_option("--factor", factor,
                   "The sender's factors of x, y, z (OSCeleton's -mx, -my, -mz)")
        ->expected(3)
        ->delimiter(',');
    app.add_option("--offset", offset,
                   "The sender's offsets of x, y, z (OSCeleton's -ox, -oy, -oz)")
        ->expected(3)
        ->delimiter(',');
    app.add_flag("--flip-y", flip_y, "The sender's y points down");
    app.add_flag("--mirrored", mirrored, "The sender shows a mirror image");
    app.add_flag(
        "--swap-sides", swap_sides,
        "The sender swaps the names of left and right; with --mirrored: it negates x only");
  }

  Result<DialectOptions> Options() const {
    DialectOptions options;
    options.units = *UnitsOf(units);
    options.factor = Eigen::Vector3d::Map(factor.data());
    options.offset = Eigen::Vector3d::Map(offset.data());
    if (!options.factor.allFinite() || options.factor.cwiseAbs().minCoeff() < 1e-6)
      return UsageError("--factor: must not be 0");
    if (!options.offset.allFinite()) return UsageError("--offset: not a number");
    options.flip_y = flip_y;
    options.mirrored = mirrored;
    options.swap_sides = swap_sides;
    return options;
  }
};

int Receive(const ReceiverOptions& options, bool json) {
  const auto done = RunReceiver(options);
  if (!done) return cli::Report(done.error());
  std::cout << (json ? text::ToText(done->statistics) + "\n" : ToText(done->statistics))
            << std::flush;
  return done->published ? 0 : cli::Report(done->published.error());
}

struct ReceiverFlags {
  DialectFlags dialect;
  std::string listen = "127.0.0.1:7110", to;
  std::vector<double> camera_m;
  double yaw_deg = 180, pitch_deg = 0, roll_deg = 0, latency_ms = 67, seconds = 0, most = 50'000;
  std::int32_t user = -1;
  std::string web, pose_package;
  bool no_publish = false;

  Result<ReceiverOptions> Options() const {
    ReceiverOptions options;
    const auto parsed = dialect.Options();
    if (!parsed) return parsed.error();
    options.tracker.dialect = *parsed;
    const auto at = transport::ParseUdp(listen, "--listen");
    if (!at) return at.error();
    options.listen = *at;
    if (!no_publish) {
      const auto address = transport::AddressOrDefault(to, "devices");
      if (!address) return address.error();
      options.to = *address;
    }
    if (!web.empty()) {
      return UsageError("--web " + web +
                        ": footing-web serves the webcam's page now; start footing-skeleton "
                        "without --web, and beside it: footing-web --listen tcp:" +
                        web + ", then open http://" + web + "/webcam");
    }
    options.tracker.stand = camera_m.empty();
    if (!camera_m.empty()) options.tracker.camera.p_W_m = Eigen::Vector3d::Map(camera_m.data());
    options.tracker.camera.yaw_rad = DegreesToRadians(yaw_deg);
    options.tracker.camera.pitch_rad = DegreesToRadians(pitch_deg);
    options.tracker.camera.roll_rad = DegreesToRadians(roll_deg);
    options.tracker.latency_ns = SecondsToNanoseconds(1e-3 * latency_ms);
    if (user >= 0) options.tracker.user = user;
    options.seconds = seconds;
    options.most_packets_per_s = most;
    return options;
  }
};

}  // namespace

std::function<void()> AddReceiver(CLI::App& app, Shared& shared) {
  const auto flags = std::make_shared<ReceiverFlags>();
  flags->dialect.Add(app);
  app.add_option("--listen", flags->listen,
                 "UDP address to receive on, HOST:PORT; 0.0.0.0:7110 takes every host's packets");
  app.add_option("--to", flags->to, device_link::kToHelp);
  app.add_option("--web", flags->web, "Moved: footing-web serves the page for a webcam");
  app.add_option("--pose-package", flags->pose_package)->group("");  // Goes with --web.
  app.add_flag("--no-publish", flags->no_publish, "Receive and check only");
  app.add_option("--user", flags->user, "Person to publish (default: the first one)");
  app.add_option(
         "--camera-m", flags->camera_m,
         "Place of the camera in the boards' frame, x,y,z in m (default: found from a person "
         "who stands on the boards and faces the camera for two seconds)")
      ->expected(3)
      ->delimiter(',');
  app.add_option("--camera-yaw-deg", flags->yaw_deg,
                 "Direction in which the camera looks, degrees: 0 the boards' front, 90 left, 180 "
                 "at a person who faces it");
  app.add_option("--camera-pitch-deg", flags->pitch_deg, "Tilt of the camera, upwards positive")
      ->check(CLI::Range(-90.0, 90.0));
  app.add_option("--camera-roll-deg", flags->roll_deg, "Roll of the camera, left side up positive")
      ->check(CLI::Range(-180.0, 180.0));
  app.add_option("--latency-ms", flags->latency_ms,
                 "Age of a skeleton at its arrival where the sender gives no time, ms")
      ->check(CLI::Range(0.0, 500.0));
  app.add_option("--max-packets-per-s", flags->most, "Packets a second to read; more are dropped")
      ->check(CLI::Range(1.0, 1e6));
  app.add_option("--seconds", flags->seconds, "Duration, s (0: until SIGINT)")
      ->check(CLI::Range(0.0, 1e6));
  return [flags, &shared] {
    const auto options = flags->Options();
    shared.exit_code = options ? Receive(*options, shared.json) : cli::Report(options.error());
  };
}

void AddSend(CLI::App& app, Shared& shared) {
  struct Flags {
    DialectFlags dialect;
    std::string clip, to = "127.0.0.1:7110", name = "footing";
    SenderOptions options;
  };
  const auto flags = std::make_shared<Flags>();
  auto* send = app.add_subcommand("send", "Play a recorded or a synthetic skeleton as OSC");
  flags->dialect.Add(*send);
  send->add_option("CLIP", flags->clip,
                   "Kinect v2 recording, CSV t_100ns,(x,y,z,state)*25 (default: a synthetic person "
                   "who stands, waves and squats)");
  send->add_option("--to", flags->to, "UDP address to send to, HOST:PORT");
  send->add_option("--dialect", flags->name,
                   "Dialect: footing, sensebloom, quartz, zillode or kinect-sdk2")
      ->check(CLI::IsMember({"footing", "sensebloom", "quartz", "zillode", "kinect-sdk2"}));
  send->add_option("--rate-scale", flags->options.rate_scale, "Speed of the clip")
      ->check(CLI::Range(0.01, 100.0));
  send->add_option("--rate-hz", flags->options.rate_hz,
                   "Frames a second, whatever the clip's times (0: as recorded)")
      ->check(CLI::Range(0.0, 1e5));
  send->add_option("--people", flags->options.people, "Send every frame for this many persons")
      ->check(CLI::Range(1, 8));
  send->add_option("--seconds", flags->options.seconds, "Duration, s; the clip repeats (0: once)")
      ->check(CLI::Range(0.0, 1e6));
  send->callback([flags, &shared] {
    const auto run = [&]() -> Result<nlohmann::ordered_json> {
      const auto dialect = flags->dialect.Options();
      if (!dialect) return dialect.error();
      const auto to = transport::ParseUdp(flags->to, "--to");
      if (!to) return to.error();
      flags->options.dialect_options = *dialect;
      flags->options.to = *to;
      flags->options.dialect = *DialectOf(flags->name);
      if (flags->clip.empty()) return SendClip(SyntheticClip(), flags->options);
      const auto text = config::ReadTextFile(flags->clip, kMostClipBytes);
      if (!text) return text.error();
      const auto clip = ReadKinectClip(*text, flags->clip);
      if (!clip) return clip.error();
      return SendClip(*clip, flags->options);
    };
    const auto statistics = run();
    if (statistics) std::cout << *statistics << std::endl;
    shared.exit_code = statistics ? 0 : cli::Report(statistics.error());
  });
}

}  // namespace footing::skeleton
