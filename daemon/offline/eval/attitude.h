#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::eval {

/// One sample of a recording, with the true orientation (S to a frame with z up) where it is known.
struct ImuSample {
  arms::HandReading reading;
  std::optional<Eigen::Quaterniond> truth;
  bool scored = true;  ///< The sample is in the scored part; all are where the file does not say.
};

/// A CSV with the columns gx,gy,gz (rad/s) and ax,ay,az (m/s^2), and perhaps qw,qx,qy,qz (empty
/// where unknown) and moving (0 or 1); errors name the line.
Result<std::vector<ImuSample>> ReadImu(const std::string& path);

/// Measurements of a simulated Wiimote with MotionPlus: every k-th sample (of at least 95 Hz), a
/// gyroscope of 595/8192 degrees/s a count, 4.5 times that above 430 degrees/s, with 0.35 degrees/s
/// of noise and a bias of (0.4, -0.3, 0.25) degrees/s; an accelerometer of 104 counts a g with
/// 0.06 m/s^2 of noise, clipped at 3.6 g. `rate_hz` becomes the new rate.
std::vector<ImuSample> AsWiimote(const std::vector<ImuSample>& samples, std::uint64_t seed,
                                 double& rate_hz);

/// Options of a trial of the attitude filter.
struct AttitudeTrialOptions {
  double rate_hz = 0;
  double still_s = 2;  ///< The device rests at first: mean force and bias come from there.
  bool rows = true;    ///< With a row a sample.
  arms::AttitudeOptions filter;
};

/// The filter over a recording; the fields of `footing-eval attitude`. Errors are against the truth
/// where there is one and the sample counts; the heading is right at the first such sample.
nlohmann::ordered_json RunAttitudeTrial(const std::vector<ImuSample>& samples,
                                        const AttitudeTrialOptions& options);

/// footing-eval attitude: the attitude of a device with gyroscope and accelerometer.
void AddAttitudeCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
