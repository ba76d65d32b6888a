#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/camera/video_port.h"
#include "common/base/result.h"
#include "common/camera/find.h"
#include "common/camera/image.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/stream/device.h"

namespace footing::camera {

/// A controller's sphere after the calibration.
struct CalibratedSphere {
  std::uint32_t led_rgb = 0;  ///< Light that it is tracked with, 0xRRGGBB.
  sphere::Blink blink;
  double distance_m = 0;  ///< From the camera, mean.
  int found = 0;          ///< Frames in which the finder found it.
};

/// Finds the sphere of each controller by switching its light, and what it looks like, in steps:
/// one controller after the other dark, lit, dark, lit; then all lit, for blur and limb darkening.
/// Light that reaches the sensor's limit is dimmed. It has no clock and switches nothing itself.
class BlinkCalibration {
 public:
  /// `radii_m`: of each controller's sphere. At most four controllers.
  BlinkCalibration(const sphere::Lens& lens, const sphere::Settings& settings,
                   std::vector<double> radii_m);

  /// The light that each controller must have now, 0xRRGGBB.
  const std::vector<std::uint32_t>& lights() const { return lights_; }
  /// Grows with every step: the lights are to be set again, even when they are the same.
  int steps() const { return steps_; }
  /// The lights have been set as wanted by this time; earlier frames show the state before.
  void LightsAreSet(std::int64_t now_ns);
  /// Takes a frame. `steps()` has grown afterwards when a step has ended; InvalidData when a step
  /// has failed three times.
  Result<void> Take(const sphere::Image& image, std::int64_t exposed_ns);
  /// Instruction for the person and the last failure; empty: as before.
  std::string TakeMessage();

  bool is_done() const { return step_ == Step::kDone; }
  /// Spheres that were calibrated, once it is done.
  const std::vector<CalibratedSphere>& spheres() const { return spheres_; }
  const sphere::Profile& profile() const { return profile_; }

 private:
  enum class Step { kDark, kLit, kAllLit, kDone };

  void Begin(Step step);
  Result<void> EndLit();
  Result<void> EndAllLit();
  Result<void> Again(const std::string& problem);
  std::string Which() const;

  sphere::Lens lens_;
  sphere::Settings loose_;
  std::vector<double> radii_m_;
  std::vector<CalibratedSphere> spheres_;
  sphere::Profile profile_;
  std::vector<std::uint32_t> lights_;
  Step step_ = Step::kDark;
  std::size_t at_ = 0;  ///< The controller that blinks.
  int steps_ = 0, blinks_ = 0, failures_ = 0, frames_ = 0;
  double level_ = 1;  ///< Brightness of its light, 0 to 1.
  std::int64_t settled_ns_;
  sphere::MeanImage dark_, lit_;
  std::vector<sphere::Finder> finder_;  ///< Finder of the last step; at most one.
  std::vector<std::vector<sphere::Estimate>> estimates_;
  std::string message_;
};

/// Options of a blink calibration of the controllers' spheres.
struct CalibrateOptions {
  frames::CameraFile camera;  ///< Its spheres are replaced; their radii stay.
  FrameOptions frames;
  transport::Address sensor;  ///< footingd's client socket, where lights are switched.
};

/// Result of a calibration: one sphere for each PS Move with a role.
struct BlinkReport {
  struct Sphere {
    stream::DeviceRole role = stream::DeviceRole::kUnspecified;
    std::string serial;
    double radius_m = 0;
    CalibratedSphere calibrated;
  };
  std::vector<Sphere> spheres;
  sphere::Profile profile;
};

/// Switches the lights of the PS Moves through footingd, and finds out from the frames what each
/// looks like. Afterwards they are lit as they are to be tracked. NoDevice without footingd or a
/// PS Move.
Result<BlinkReport> Calibrate(const CalibrateOptions& options);

/// The lights of the PS Moves that footingd has, switched through its client socket as footing-ctl
/// led does. Everything runs on the io_context's thread.
class Lights {
 public:
  /// `on_devices` is called for every list of devices, about once a second and at every change.
  Lights(boost::asio::io_context& io, const transport::Address& address,
         std::function<void()> on_devices);

  void Start() { client_.Start(); }
  void Stop() { client_.Stop(); }

  /// PS Moves that are there and have a role, in the order of their roles.
  const std::vector<stream::DeviceStatus>& moves() const { return moves_; }
  /// Whether a list of devices has come; else `link()` says why not.
  bool has_list() const { return has_list_; }
  const std::string& link() const { return link_; }

  /// Sets one light, 0xRRGGBB; `done` gets footingd's refusal.
  void Set(std::uint32_t device, std::uint32_t rgb, std::function<void(Result<void>)> done);

 private:
  void OnTick(const v1::Tick& tick);

  std::function<void()> on_devices_;
  std::vector<stream::DeviceStatus> moves_;
  bool has_list_ = false;
  std::string link_ = "not connected";
  transport::Client client_;
};

}  // namespace footing::camera
