#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "daemon/simulation/engine/engine.h"

/// Measures of how a settled gait moves, beside the published curves of people and birds.
namespace footing::style {

/// First harmonic of an angle about its mean: amplitude (half of peak to peak), and the time of its
/// peak after touchdown as a fraction of the step, in [-1, 1) for one of the stride and in [-0.5,
/// 0.5) for one of the step.
struct Swing {
  double amplitude_rad = 0;
  double peak_phase = 0;
};

/// Means over the whole steps that were seen, straight ahead on level ground. A step goes from
/// touchdown to touchdown, a stride is two steps.
struct GaitStyle {
  int steps = 0;
  double speed_mps = 0;
  double cadence_hz = 0;  ///< Steps a second.
  double step_length_m = 0;
  double step_width_m = 0;  ///< Between the lines of the feet; 0 in jumps.
  double bob_m = 0;         ///< COM, vertical, peak to peak in a step.
  double bob_low_phase =
      0;                ///< Phase of the COM's lowest point, in [-0.5, 0.5); 0 is at touchdown.
  double sway_m = 0;    ///< COM, sideways, peak to peak in a stride, first harmonic.
  double lean_rad = 0;  ///< Mean pitch; forward positive.
  Swing pitch;          ///< Twice in a stride. Peak: furthest forward.
  Swing roll;           ///< Once in a stride. Peak: the hip of the supporting side is highest.
  Swing yaw;  ///< Once in a stride. Peak: the hip of the leg that landed is furthest ahead.
  double double_support_share = 0;  ///< Time with both feet loaded.
  double flight_share = 0;          ///< Time with none.
  double slide_mean_m = 0;   ///< Slide of a foot's touching point over the ground in a stance, ...
  double slide_max_m = 0;    ///< ... the furthest from where it first touched.
  double penetration_m = 0;  ///< Deepest, of the foot's ball into level ground.
  double jerk_rms_mps3 = 0;  ///< COM, over 10 ms.
  double work_n = 0;         ///< Joints' |effort x rate| over the way; cost of transport x weight.
  double asymmetry = 0;      ///< |left - right| / mean, of step times or lengths: the larger.
};

/// Measures one gait, millisecond by millisecond.
class StyleMeter {
 public:
  explicit StyleMeter(double step_s) : step_s_(step_s) {}

  void Add(const engine::EngineOutput& output);
  GaitStyle Report() const;

 private:
  struct Sample {
    double height_m, left_m, pitch_rad, roll_rad, yaw_rad;
  };
  struct Side {
    bool down = false;
    double changed_s = 0;  ///< Since when it looks otherwise.
    double landed_s = 0;
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();  ///< Lowest point of the ball.
    Eigen::Quaterniond shank;
    std::array<double, 4> joints{};  ///< Yaw, roll, pitch, rad; length, m.
    Eigen::Vector2d slid_m = Eigen::Vector2d::Zero();
    double furthest_m = 0;
    Eigen::Vector3d foothold_W_m = Eigen::Vector3d::Zero();
    double times_s = 0, lengths_m = 0;  ///< Sums over its steps as the supporting leg.
    int steps = 0;
  };
  /// Sums over steps.
  struct Sums {
    double time_s = 0, way_m = 0, width_m = 0, bob_m = 0, both_s = 0, none_s = 0;
    Eigen::Vector2d height = Eigen::Vector2d::Zero(), left = height, pitch = height;
    Eigen::Vector2d roll = height, yaw = height;
    double lean_rad = 0, energy_j = 0, penetration_m = 0, jerk_squared = 0;
    int steps = 0, widths = 0, jerks = 0;
  };
  struct Slides {
    double sum_m = 0, max_m = 0;
    int stances = 0;
  };

  void AddSide(const engine::EngineOutput& output, std::size_t side);
  void AddJerk(const engine::EngineOutput& output);
  void EndStep(const engine::EngineOutput& output);

  double step_s_;
  double time_s_ = 0;
  std::optional<std::uint64_t> steps_;  ///< Touchdowns so far.
  std::vector<Sample> step_;            ///< The present one, from its touchdown on.
  bool whole_ = false;                  ///< It was seen from its touchdown on.
  std::size_t carries_ = 0;             ///< Leg that carries in it.
  Eigen::Vector3d started_W_m = Eigen::Vector3d::Zero();  ///< COM at its touchdown.
  std::array<Side, 2> sides_;
  std::array<Eigen::Vector3d, 2> velocities_;  ///< 10 and 20 ms ago.
  int ticks_ = 0;
  Sums sums_;
  Slides slides_;
};

/// Height of the hips that the published curves are read with: the gait paper's legs are about 1 m
/// long.
inline constexpr double kHipHeightM = 1.0;

/// Stride length over speed by Alexander (1976, Nature 261, 129), from walks and runs of people,
/// other mammals and birds: u = 0.25 g^0.5 stride^1.67 hip height^-1.17. Steps a second.
double AlexanderCadence(double speed_mps, double hip_height_m);

/// COM, vertical, peak to peak, of people who walk at 0.7 to 1.6 m/s (Orendurff et al. 2004, J
/// Rehabil Res Dev 41, 829: 27.4 mm at 0.7 m/s, 48.3 mm at 1.6 m/s), linear between and beyond; m.
double OrendurffBob(double speed_mps);

/// Roll and yaw of the pelvis in a free walk (Saunders, Inman and Eberhart 1953, J Bone Joint Surg
/// 35-A, 543): 5 degrees with the supporting side's hip highest shortly before the middle of the
/// step, and 4 degrees with the landing leg's hip furthest ahead at touchdown. They hold at 1.2
/// m/s. At other speeds they are taken in proportion to Alexander's step length, which is ours.
struct PelvisReference {
  Swing roll, yaw;
};
PelvisReference SaundersPelvis(double speed_mps);

/// How far a harmonic is from another one, in the unit of their amplitudes: the length of the
/// difference of their vectors, so that a wrong phase of a small swing matters little. `turns`: of
/// the phase in a step; 0.5 for a harmonic of the stride, 1 for one of the step.
double Distance(double amplitude, double phase, double other_amplitude, double other_phase,
                double turns);

}  // namespace footing::style
