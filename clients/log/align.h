#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "clients/log/time_offset.h"
#include "common/base/result.h"
#include "common/recording/recorded_session.h"
#include "common/virtual/motion/markers.h"

namespace footing::log_client {

/// Forces that the boards of one rig measured, at 100 Hz. Times count from the recording's first
/// message, as `recording_time_s` of the exports.
struct BoardForces {
  Series total;  ///< Sum of the boards; NaN where one of them says nothing.
  std::array<Eigen::VectorXd, 2> load_n;    ///< Left, right; empty without that board.
  std::array<Eigen::Matrix2Xd, 2> cop_W_m;  ///< NaN where it is not valid.
};

/// `rig` empty: the first one with a board. InvalidData where no board sent forces, one sent them
/// without its calibration, or they span more than kLongestSeriesS.
Result<BoardForces> ReadBoards(const recording::RecordedSession& session, const std::string& rig);

/// A recording of another system: the vertical force on the person, and the markers if any.
struct ForeignMotion {
  bool from_markers = false;  ///< The force is mass (g + z'') of the markers' centre of mass.
  Series force;
  std::optional<motion::MarkerTracks> markers;  ///< In axes like W's: z is up.
  std::string note;                             ///< Anything that had to be assumed; may be empty.
};

/// Reads C3D (its force plates, otherwise its markers), TRC, MOT, STO, or a CSV file with the
/// columns time_s and force_n. `standing_n` is the weight of the markers' person. InvalidData where
/// the file has neither forces nor markers, is cut, or its lengths are not a person's.
Result<ForeignMotion> ReadForeign(const std::string& path, double standing_n);

/// Height of the centre of mass of the person's markers, m, a value a frame; NaN where too few are
/// seen. `note` says if the markers are not known.
Eigen::VectorXd CentreOfMassHeight(const motion::MarkerTracks& tracks, std::string& note);

/// How a recording and a file are to be put on one clock.
struct AlignOptions {
  std::string file, with;
  std::string rig;
  std::string marker;          ///< Text of a marker in the recording, ...
  std::optional<double> at_s;  ///< ... and its time in the file; otherwise that of its C3D event.
  bool lsl_clock = false;      ///< The file's times are those of LSL's clock.
  double most_sd_s = 0.005;
  std::string out;  ///< Folder for ground forces on the file's clock; empty: none.
  bool replace = false;
};

/// Two clocks put beside each other.
struct Alignment {
  std::string method;  ///< "forces", "markers", "marker" or "lsl".
  std::string note;
  std::optional<TimeOffset> offset;  ///< Nothing where nothing moves in both.
  /// Files written, how many of their frames the boards say nothing about, and how far the feet are
  /// from where the boards were pressed, m (nothing: the boards' place in the file is not known).
  std::vector<std::string> files;
  std::uint64_t frames = 0, unmeasured_frames = 0;
  std::optional<double> placement_rms_m;
};

/// Finds the offset of the file's clock, and writes the forces where it is sure.
Result<Alignment> Align(const AlignOptions& options);

}  // namespace footing::log_client
