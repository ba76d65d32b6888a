#include "daemon/simulation/biped/world.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "common/base/text.h"

namespace footing::physics {
namespace {

void ApplyForces(mjData& state, int root, const JointEfforts& efforts,
                 const Eigen::Vector3d& push_W_n) {
  std::copy(efforts.begin(), efforts.end(), state.qfrc_applied + kRootDofs);
  std::copy(push_W_n.data(), push_W_n.data() + 3, state.xfrc_applied + 6 * root);
}

void KeepQuaternion(const mjData& state, std::array<double, 4>& quaternion) {
  std::copy(state.qpos + 3, state.qpos + 7, quaternion.begin());
}

std::uint64_t AddToHash(std::uint64_t hash, const mjtNum* words, int count) {
  for (int i = 0; i < count; ++i) {
    hash = text::AddFnv(hash, std::bit_cast<std::uint64_t>(words[i]));
  }
  return hash;
}

}  // namespace

World::World(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

Result<World> World::FromMjcf(const std::string& mjcf, const WorldNames& names) {
  Result<ModelPointer> model = Compile(mjcf);
  if (!model) return model.error();
  auto shared = std::make_shared<WorldModel>();
  shared->model = std::move(*model);
  const mjModel& m = *shared->model;
  if (m.nv != kDofs || m.nq != kDofs + 1) {
    return InvalidData("the world has " + std::to_string(m.nv) +
                       " degrees of freedom instead of 14; check the MJCF writer");
  }
  const auto find = [&m](mjtObj type, const auto& wanted, auto& ids) -> Result<void> {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Result<int> id = IdOf(m, type, wanted[i]);
      if (!id) return id.error();
      ids[i] = *id;
    }
    return {};
  };
  shared->ground.resize(names.ground.size());
  for (const auto& found :
       {find(mjOBJ_BODY, names.links, shared->links), find(mjOBJ_BODY, names.hips, shared->hips),
        find(mjOBJ_GEOM, names.feet, shared->feet),
        find(mjOBJ_GEOM, names.ground, shared->ground)}) {
    if (!found) return found.error();
  }
  for (const int link : shared->links) shared->mass_kg += m.body_mass[link];
  shared->clearance = Clearance(m, {shared->feet.begin(), shared->feet.end()});
  World world(MakeParts(std::move(shared)));
  world.Reset({0, 0, 1}, 0, {});
  return world;
}

World World::Twin() const { return World(MakeParts(parts_->shared)); }

std::unique_ptr<World::Parts> World::MakeParts(std::shared_ptr<WorldModel> shared) {
  auto parts = std::make_unique<Parts>();
  parts->state.reset(mj_makeData(shared->model.get()));
  FOOTING_CHECK(parts->state != nullptr);
  parts->shared = std::move(shared);
  return parts;
}

double World::step_s() const { return parts_->shared->model->opt.timestep; }
double World::mass_kg() const { return parts_->shared->mass_kg; }
double World::root_force_max_n() const { return parts_->root_force_max_n; }
const Observation& World::Observe() const { return parts_->observation; }

void World::Reset(const Eigen::Vector3d& p_WB_m, double heading_rad,
                  const std::array<double, kJoints>& joint_position) {
  Parts& p = *parts_;
  mjData& d = *p.state;
  mj_resetData(p.shared->model.get(), &d);
  std::copy(p_WB_m.data(), p_WB_m.data() + 3, d.qpos);
  d.qpos[3] = std::cos(heading_rad / 2);
  d.qpos[4] = d.qpos[5] = 0;
  d.qpos[6] = std::sin(heading_rad / 2);
  std::copy(joint_position.begin(), joint_position.end(), d.qpos + 7);
  KeepQuaternion(d, p.root_quaternion);
  p.shared->model->opt.collision = mjCOL_ALL;
  mj_forward(p.shared->model.get(), &d);
  ReadContacts(*p.shared->model, d, p.shared->feet, p.observation);
  ReadMotion(*p.shared->model, d, p.shared->links, p.shared->hips, p.shared->feet,
             p.shared->mass_kg, p.observation);
}

void World::PlaceBox(int index, const Eigen::Vector3d& centre_W_m, const Eigen::Quaterniond& q_WS,
                     const Eigen::Vector3d& half_size_m) {
  mjModel& m = *parts_->shared->model;
  const int geom = parts_->shared->ground[static_cast<std::size_t>(index)];
  std::copy(centre_W_m.data(), centre_W_m.data() + 3, m.geom_pos + 3 * geom);
  std::copy(half_size_m.data(), half_size_m.data() + 3, m.geom_size + 3 * geom);
  const std::array<double, 4> quaternion{q_WS.w(), q_WS.x(), q_WS.y(), q_WS.z()};
  std::copy(quaternion.begin(), quaternion.end(), m.geom_quat + 4 * geom);
  m.geom_rbound[geom] = half_size_m.norm();
  parts_->shared->clearance.MoveGround(m, geom);
}

// mj_step is mj_step1 then mj_step2. Cut between them, a step leaves positions and velocities of
// the new state computed, which control needs, and the next step goes on from there at no cost.
void World::Step(const JointEfforts& efforts, const Eigen::Vector3d& push_W_n) {
  Parts& p = *parts_;
  mjData& d = *p.state;
  ApplyForces(d, p.shared->links[0], efforts, push_W_n);
  const double hidden_n = HiddenRootForce(*p.shared->model, d, p.shared->links[0], push_W_n);
  p.root_force_max_n = std::max(p.root_force_max_n, hidden_n);
  FOOTING_CHECK(hidden_n == 0);
  mj_step2(p.shared->model.get(), &d);
  KeepQuaternion(d, p.root_quaternion);
  ReadContacts(*p.shared->model, d, p.shared->feet, p.observation);
  p.shared->model->opt.collision =
      p.shared->clearance.FeetAlone(*p.shared->model, d) ? mjCOL_PAIR : mjCOL_ALL;
  mj_step1(p.shared->model.get(), &d);
  ReadMotion(*p.shared->model, d, p.shared->links, p.shared->hips, p.shared->feet,
             p.shared->mass_kg, p.observation);
  ++p.steps;
}

void World::StepBare(const JointEfforts& efforts, const Eigen::Vector3d& push_W_n) {
  ApplyForces(*parts_->state, parts_->shared->links[0], efforts, push_W_n);
  std::copy(parts_->root_quaternion.begin(), parts_->root_quaternion.end(),
            parts_->state->qpos + 3);
  parts_->shared->model->opt.collision = mjCOL_ALL;
  mj_step(parts_->shared->model.get(), parts_->state.get());
  KeepQuaternion(*parts_->state, parts_->root_quaternion);
}

void World::LinkPose(int index, Eigen::Vector3d& position_m,
                     Eigen::Quaterniond& orientation) const {
  const mjData& d = *parts_->state;
  const int link = parts_->shared->links[static_cast<std::size_t>(index)];
  position_m = Eigen::Map<const Eigen::Vector3d>(d.xpos + 3 * link);
  const mjtNum* q = d.xquat + 4 * link;
  orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
}

std::uint64_t World::StateHash() const {
  const mjModel& m = *parts_->shared->model;
  const mjData& d = *parts_->state;
  std::uint64_t hash = text::kFnvBasis;
  hash = AddToHash(hash, d.qpos, 3);
  hash = AddToHash(hash, parts_->root_quaternion.data(), 4);
  hash = AddToHash(hash, d.qpos + 7, m.nq - 7);
  hash = AddToHash(hash, d.qvel, m.nv);
  hash = AddToHash(hash, d.act, m.na);
  return AddToHash(hash, d.qacc_warmstart, m.nv);
}

WorldState World::Save() const {
  const mjData& d = *parts_->state;
  WorldState state;
  state.steps = parts_->steps;
  std::copy(d.qpos, d.qpos + state.qpos.size(), state.qpos.begin());
  std::copy(parts_->root_quaternion.begin(), parts_->root_quaternion.end(), state.qpos.begin() + 3);
  std::copy(d.qvel, d.qvel + state.qvel.size(), state.qvel.begin());
  std::copy(d.qacc_warmstart, d.qacc_warmstart + state.qacc_warmstart.size(),
            state.qacc_warmstart.begin());
  state.normal_force_n = parts_->observation.normal_force_n;
  state.contact_force_W_n = parts_->observation.contact_force_W_n;
  state.other_contact = parts_->observation.other_contact;
  state.root_force_max_n = parts_->root_force_max_n;
  return state;
}

void World::Restore(const WorldState& state) {
  Parts& p = *parts_;
  mjData& d = *p.state;
  mj_resetData(p.shared->model.get(), &d);
  std::copy(state.qpos.begin(), state.qpos.end(), d.qpos);
  std::copy(state.qvel.begin(), state.qvel.end(), d.qvel);
  std::copy(state.qacc_warmstart.begin(), state.qacc_warmstart.end(), d.qacc_warmstart);
  KeepQuaternion(d, p.root_quaternion);
  p.steps = state.steps;
  p.root_force_max_n = state.root_force_max_n;
  p.observation.normal_force_n = state.normal_force_n;
  p.observation.contact_force_W_n = state.contact_force_W_n;
  p.observation.other_contact = state.other_contact;
  p.shared->model->opt.collision = mjCOL_ALL;
  mj_step1(p.shared->model.get(), &d);
  ReadMotion(*p.shared->model, d, p.shared->links, p.shared->hips, p.shared->feet,
             p.shared->mass_kg, p.observation);
}

namespace {

/// No point of the mechanism goes as far in one step: 50 m/s at 2 ms. A world that does has
/// diverged.
constexpr double kFarthestStepM = 0.1;

}  // namespace

Clearance::Clearance(const mjModel& model, const std::vector<int>& feet) {
  const int grounds = model.body_geomnum[0];
  ground_.resize(static_cast<std::size_t>(grounds));
  for (int geom = 0; geom < grounds; ++geom) MoveGround(model, geom);
  for (int geom = grounds; geom < model.ngeom; ++geom) {
    if (std::find(feet.begin(), feet.end(), geom) == feet.end()) shells_.push_back(geom);
  }
  pairs_complete_ = model.npair == grounds * static_cast<int>(feet.size());
}

void Clearance::MoveGround(const mjModel& model, int geom) {
  Ground& ground = ground_[static_cast<std::size_t>(geom)];
  ground.centre_W_m = Eigen::Map<const Eigen::Vector3d>(model.geom_pos + 3 * geom);
  mjtNum R_WG[9];
  mju_quat2Mat(R_WG, model.geom_quat + 4 * geom);
  ground.R_GW = Eigen::Map<const Eigen::Matrix3d>(R_WG);  // Row order: the transpose.
  const bool box = model.geom_type[geom] == mjGEOM_BOX;
  ground.half_size_m =
      box ? Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(model.geom_size + 3 * geom))
          : Eigen::Vector3d(INFINITY, INFINITY, 0);
}

/// Whether a sphere may touch the ground: one beyond any of its faces does not.
bool Clearance::Reaches(const Ground& ground, const Eigen::Vector3d& centre_W_m, double radius_m) {
  const Eigen::Vector3d offset_W_m = centre_W_m - ground.centre_W_m;
  for (const int axis : {2, 0, 1}) {  // Mostly it is above.
    const double along_m = ground.R_GW.row(axis).dot(offset_W_m);
    const double reach_m = ground.half_size_m[axis] + radius_m;
    if (along_m > reach_m) return false;
    if (along_m < -reach_m && std::isfinite(ground.half_size_m.x())) return false;
  }
  return true;
}

bool Clearance::FeetAlone(const mjModel& model, const mjData& state) const {
  if (!pairs_complete_) return false;
  for (const int shell : shells_) {
    const Eigen::Vector3d centre_W_m =
        Eigen::Map<const Eigen::Vector3d>(state.geom_xpos + 3 * shell);
    const double radius_m = model.geom_rbound[shell] + kFarthestStepM;
    for (const Ground& ground : ground_) {
      if (Reaches(ground, centre_W_m, radius_m)) return false;
    }
  }
  return true;
}

namespace {

void IgnoreWarning(const char*) {}
void AbortOnError(const char* message) { CheckFailed(message, "MuJoCo", 0); }

/// Once, since they are globals of MuJoCo and worlds are compiled on several threads.
void TakeItsMessages() {
  [[maybe_unused]] static const bool taken = [] {
    mju_user_warning = IgnoreWarning;
    mju_user_error = AbortOnError;
    return true;
  }();
}

struct DeleteVfs {
  void operator()(mjVFS* files) const {
    mj_deleteVFS(files);
    delete files;
  }
};

}  // namespace

Result<ModelPointer> Compile(const std::string& mjcf) {
  TakeItsMessages();
  const char* name = "world.xml";
  std::unique_ptr<mjVFS, DeleteVfs> files(new mjVFS);
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), name, static_cast<int>(mjcf.size()));
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());

  std::array<char, 1000> reason{};
  ModelPointer model(mj_loadXML(name, files.get(), reason.data(), static_cast<int>(reason.size())));
  if (!model) {
    return InvalidData(std::string("the world does not compile: ") + reason.data() +
                       "; check the numbers of the biped's and the track's file");
  }
  return model;
}

Result<int> IdOf(const mjModel& model, mjtObj type, const std::string& name) {
  const int id = mj_name2id(&model, type, name.c_str());
  if (id < 0) return InvalidData("the world has no \"" + name + "\"; check the MJCF writer");
  return id;
}

namespace {

Eigen::Vector3d Vector(const mjtNum* values) { return {values[0], values[1], values[2]}; }

}  // namespace

void ReadContacts(const mjModel& model, mjData& state, const std::array<int, kLegs>& feet,
                  Observation& observation) {
  observation.normal_force_n.fill(0);
  observation.contact_force_W_n.setZero();
  observation.other_contact = false;
  for (int i = 0; i < state.ncon; ++i) {
    const mjContact& contact = state.contact[i];
    mjtNum force[6];  // Contact frame: its first axis is the normal, from geom1 to geom2.
    mj_contactForce(&model, &state, i, force);
    // The force on geom2; MuJoCo puts a plane first, but a box behind the foot.
    const double sign = model.geom_bodyid[contact.geom1] == 0 ? 1 : -1;
    for (int axis = 0; axis < 3; ++axis) {
      observation.contact_force_W_n += sign * force[axis] * Vector(contact.frame + 3 * axis);
    }
    bool foot = false;
    for (int leg = 0; leg < kLegs; ++leg) {
      if (contact.geom1 != feet[leg] && contact.geom2 != feet[leg]) continue;
      observation.normal_force_n[leg] += force[0];
      foot = true;
    }
    if (!foot) observation.other_contact = true;
  }
}

void ReadMotion(const mjModel& model, const mjData& state, const std::array<int, kLinks>& links,
                const std::array<int, kLegs>& hips, const std::array<int, kLegs>& feet,
                double mass_kg, Observation& observation) {
  const int root = links[0];
  observation.diverged = state.warning[mjWARN_BADQPOS].number > 0 ||
                         state.warning[mjWARN_BADQVEL].number > 0 ||
                         state.warning[mjWARN_BADQACC].number > 0;
  observation.p_WB = Vector(state.qpos);
  observation.v_WB = Vector(state.qvel);
  observation.R_WB =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.xmat + 9 * root);
  observation.w_WB = observation.R_WB * Vector(state.qvel + 3);
  for (int i = 0; i < kJoints; ++i) {
    observation.joint_position[i] = state.qpos[7 + i];
    observation.joint_velocity[i] = state.qvel[kRootDofs + i];
  }
  observation.p_WC = Vector(state.subtree_com + 3 * root);
  // cvel is (angular, linear) at the mechanism's COM, so each link's COM moves with
  // v + w x (its COM - the mechanism's COM).
  Eigen::Vector3d momentum_W = Eigen::Vector3d::Zero();
  for (const int link : links) {
    const Eigen::Vector3d w = Vector(state.cvel + 6 * link);
    const Eigen::Vector3d v = Vector(state.cvel + 6 * link + 3);
    const Eigen::Vector3d arm = Vector(state.xipos + 3 * link) - observation.p_WC;
    momentum_W += model.body_mass[link] * (v + w.cross(arm));
  }
  observation.v_WC = momentum_W / mass_kg;
  for (int leg = 0; leg < kLegs; ++leg) {
    observation.p_WH[leg] = Vector(state.xpos + 3 * hips[leg]);
    observation.p_WF[leg] = Vector(state.geom_xpos + 3 * feet[leg]);
  }
}

double HiddenRootForce(const mjModel& model, const mjData& state, int root,
                       const Eigen::Vector3d& push_W_n) {
  double largest = 0;
  for (int i = 0; i < kRootDofs; ++i) {
    largest = std::max({largest, std::fabs(state.qfrc_applied[i]), std::fabs(state.qfrc_passive[i]),
                        std::fabs(state.qfrc_actuator[i])});
  }
  for (int body = 0; body < model.nbody; ++body) {
    for (int i = 0; i < 6; ++i) {
      const double expected = body == root && i < 3 ? push_W_n[i] : 0;
      largest = std::max(largest, std::fabs(state.xfrc_applied[6 * body + i] - expected));
    }
  }
  return largest;
}

}  // namespace footing::physics
