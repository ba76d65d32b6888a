#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace footing::scene {

/// One foot of a reconstructed body.
struct BodyFoot {
  bool contact = false;
  bool valid = false;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance_m2 = Eigen::Vector3d::Zero();
  double load_n = 0;
  bool cop_valid = false;
  Eigen::Vector3d cop_m = Eigen::Vector3d::Zero();
  double airborne_s = 0;
};

/// How a reconstructed body is estimated and how well: character.proto says what each field means.
struct BodyState {
  std::string subject;
  std::string mode;
  bool calibrated = false;
  double calibration_progress = 0;  ///< 0 to 1.
  std::uint32_t calibration_restarts = 0;
  double mass_kg = 0;
  double height_m = 0;
  double lag_s = 0;
  bool momentum_valid = false;
  Eigen::Vector3d com_variance_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum_kgm2ps = Eigen::Vector3d::Zero();
  std::array<BodyFoot, 2> feet;  ///< Left, right.
  std::uint32_t resets = 0;
  std::vector<double> link_sd_m;
  std::string note;
  double solve_us = 0;
  std::array<bool, 2> hands_seen{};
  std::string hands_source;    ///< "wiimote", a tracker's name; empty: no source reports the hands.
  std::string contact_source;  ///< "boards" or "insoles"; empty of a server that does not say.
};

/// The true pose of a simulated body.
struct ReferencePose {
  std::int64_t received_ns = 0;  ///< On the viewer's clock, like the next.
  std::int64_t sampled_ns = 0;
  std::vector<int> parents;
  std::vector<Eigen::Vector3d> positions_m;  ///< Of each joint, W.
};

}  // namespace footing::scene
