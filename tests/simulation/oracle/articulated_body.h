#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/biped/world.h"

/// A second engine for the same biped, to judge the first one by: Featherstone's articulated-body
/// algorithm (Rigid Body Dynamics Algorithms, 2008, table 7.1) and spring-damper contact, written
/// by hand, sharing no code with MuJoCo.
namespace footing::oracle {

using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< Angular part first.
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Foot balls on the plane z = 0.
struct Contact {
  double stiffness_n_per_m = 30000;
  double damping_ns_per_m = 350;
  double tangential_stiffness_n_per_m = 30000;
  double tangential_damping_ns_per_m = 250;
  double twist_stiffness_nm_per_rad = 300;
  double twist_damping_nms_per_rad = 3;
};

/// The floating biped over a level plane. Steps by semi-implicit Euler in the same coordinates as
/// MuJoCo: world velocity of the body's origin, angular velocity in the body's frame.
class ArticulatedBiped {
 public:
  explicit ArticulatedBiped(const biped::BipedParameters& biped, double step_s = 0.001);

  /// As physics::World's.
  void Reset(const Eigen::Vector3d& p_WB_m, double heading_rad,
             const std::array<double, physics::kJoints>& joint_position);
  void Step(const physics::JointEfforts& efforts, const Eigen::Vector3d& push_W_n);
  const physics::Observation& Observe() const { return seen_; }

  /// Velocities of the start, for flights: of the body in the world, and of the joints.
  void SetVelocity(const Eigen::Vector3d& v_WB_mps, const Eigen::Vector3d& w_WB_radps,
                   const std::array<double, physics::kJoints>& joint_velocity);
  /// Momentum of the whole mechanism about its own COM, kg m2/s, and its energy without springs, J.
  Eigen::Vector3d AngularMomentum() const;
  double Energy() const;

  double step_s() const { return step_s_; }
  double mass_kg() const { return biped_.mass_kg(); }

 private:
  static constexpr int kBodies = 1 + physics::kJoints;  ///< The root and one a joint.

  /// A body and the joint that carries it; the links between a hip's hinges weigh nothing.
  struct Body {
    int parent = -1;
    Vector6 axis = Vector6::Zero();  ///< Motion subspace in the body's own frame.
    Eigen::Vector3d r_parent_m = Eigen::Vector3d::Zero();  ///< Joint in the parent's frame.
    Matrix6 inertia = Matrix6::Zero();                     ///< About the frame's origin.
    double mass_kg = 0;
    Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
    double armature = 0;
  };

  struct FootContact {
    bool touching = false;
    Eigen::Vector2d anchor_W_m = Eigen::Vector2d::Zero();
    double twist_rad = 0;
    double normal_force_n = 0;
    Eigen::Vector3d force_W_n = Eigen::Vector3d::Zero();
    double twist_nm = 0;
  };

  void Place();
  void TouchGround(int leg);
  void Accelerate(const physics::JointEfforts& efforts, const Eigen::Vector3d& push_W_n,
                  Vector6& root_acceleration, std::array<double, physics::kJoints>& joints) const;
  void ReadObservation();
  int KneeOf(int leg) const { return 4 * leg + 4; }

  biped::BipedParameters biped_;
  Contact contact_;
  double step_s_;
  std::array<Body, kBodies> bodies_;

  Eigen::Vector3d p_WB_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WB_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_B_ = Eigen::Vector3d::Zero();
  std::array<double, physics::kJoints> position_{};
  std::array<double, physics::kJoints> velocity_{};
  std::array<FootContact, physics::kLegs> contacts_;

  // Results for the present state, by Place.
  std::array<Matrix6, kBodies> from_parent_;  ///< Motion vectors, parent to body frame.
  std::array<Vector6, kBodies> twist_;        ///< Spatial velocity in the body's frame.
  std::array<Eigen::Matrix3d, kBodies> R_W_;
  std::array<Eigen::Vector3d, kBodies> p_W_;
  physics::Observation seen_;
};

}  // namespace footing::oracle
