#include "daemon/simulation/biped/world.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/base/fnv.h"
#include "daemon/simulation/biped/parts.h"

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
  auto parts = std::make_unique<Parts>();
  parts->model = std::move(*model);
  const mjModel& m = *parts->model;
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
  parts->ground.resize(names.ground.size());
  for (const auto& found :
       {find(mjOBJ_BODY, names.links, parts->links), find(mjOBJ_BODY, names.hips, parts->hips),
        find(mjOBJ_GEOM, names.feet, parts->feet), find(mjOBJ_GEOM, names.ground, parts->ground)}) {
    if (!found) return found.error();
  }
  for (const int link : parts->links) parts->mass_kg += m.body_mass[link];
  parts->clearance = Clearance(m, {parts->feet.begin(), parts->feet.end()});
  parts->state.reset(mj_makeData(&m));
  FOOTING_CHECK(parts->state != nullptr);
  World world(std::move(parts));
  world.Reset({0, 0, 1}, 0, {});
  return world;
}

double World::step_s() const { return parts_->model->opt.timestep; }
double World::mass_kg() const { return parts_->mass_kg; }
double World::root_force_max_n() const { return parts_->root_force_max_n; }
const Observation& World::Observe() const { return parts_->observation; }

void World::Reset(const Eigen::Vector3d& p_WB_m, double heading_rad,
                  const std::array<double, kJoints>& joint_position) {
  Parts& p = *parts_;
  mjData& d = *p.state;
  mj_resetData(p.model.get(), &d);
  std::copy(p_WB_m.data(), p_WB_m.data() + 3, d.qpos);
  d.qpos[3] = std::cos(heading_rad / 2);
  d.qpos[4] = d.qpos[5] = 0;
  d.qpos[6] = std::sin(heading_rad / 2);
  std::copy(joint_position.begin(), joint_position.end(), d.qpos + 7);
  KeepQuaternion(d, p.root_quaternion);
  p.model->opt.collision = mjCOL_ALL;
  mj_forward(p.model.get(), &d);
  ReadContacts(*p.model, d, p.feet, p.observation);
  ReadMotion(*p.model, d, p.links, p.hips, p.feet, p.mass_kg, p.observation);
}

void World::PlaceBox(int index, const Eigen::Vector3d& centre_W_m, const Eigen::Quaterniond& q_WS,
                     const Eigen::Vector3d& half_size_m) {
  mjModel& m = *parts_->model;
  const int geom = parts_->ground[static_cast<std::size_t>(index)];
  std::copy(centre_W_m.data(), centre_W_m.data() + 3, m.geom_pos + 3 * geom);
  std::copy(half_size_m.data(), half_size_m.data() + 3, m.geom_size + 3 * geom);
  const std::array<double, 4> quaternion{q_WS.w(), q_WS.x(), q_WS.y(), q_WS.z()};
  std::copy(quaternion.begin(), quaternion.end(), m.geom_quat + 4 * geom);
  m.geom_rbound[geom] = half_size_m.norm();
  parts_->clearance.MoveGround(m, geom);
}

// mj_step is mj_step1 then mj_step2. Cut between them, a step leaves positions and velocities of
// the new state computed, which control needs, and the next step goes on from there at no cost.
void World::Step(const JointEfforts& efforts, const Eigen::Vector3d& push_W_n) {
  Parts& p = *parts_;
  mjData& d = *p.state;
  ApplyForces(d, p.links[0], efforts, push_W_n);
  const double hidden_n = HiddenRootForce(*p.model, d, p.links[0], push_W_n);
  p.root_force_max_n = std::max(p.root_force_max_n, hidden_n);
  FOOTING_CHECK(hidden_n == 0);
  mj_step2(p.model.get(), &d);
  KeepQuaternion(d, p.root_quaternion);
  ReadContacts(*p.model, d, p.feet, p.observation);
  p.model->opt.collision = p.clearance.FeetAlone(*p.model, d) ? mjCOL_PAIR : mjCOL_ALL;
  mj_step1(p.model.get(), &d);
  ReadMotion(*p.model, d, p.links, p.hips, p.feet, p.mass_kg, p.observation);
  ++p.steps;
}

void World::StepBare(const JointEfforts& efforts, const Eigen::Vector3d& push_W_n) {
  ApplyForces(*parts_->state, parts_->links[0], efforts, push_W_n);
  std::copy(parts_->root_quaternion.begin(), parts_->root_quaternion.end(),
            parts_->state->qpos + 3);
  parts_->model->opt.collision = mjCOL_ALL;
  mj_step(parts_->model.get(), parts_->state.get());
  KeepQuaternion(*parts_->state, parts_->root_quaternion);
}

void World::LinkPose(int index, Eigen::Vector3d& position_m,
                     Eigen::Quaterniond& orientation) const {
  const mjData& d = *parts_->state;
  const int link = parts_->links[static_cast<std::size_t>(index)];
  position_m = Eigen::Map<const Eigen::Vector3d>(d.xpos + 3 * link);
  const mjtNum* q = d.xquat + 4 * link;
  orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
}

std::uint64_t World::StateHash() const {
  const mjModel& m = *parts_->model;
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
  mj_resetData(p.model.get(), &d);
  std::copy(state.qpos.begin(), state.qpos.end(), d.qpos);
  std::copy(state.qvel.begin(), state.qvel.end(), d.qvel);
  std::copy(state.qacc_warmstart.begin(), state.qacc_warmstart.end(), d.qacc_warmstart);
  KeepQuaternion(d, p.root_quaternion);
  p.steps = state.steps;
  p.root_force_max_n = state.root_force_max_n;
  p.observation.normal_force_n = state.normal_force_n;
  p.observation.contact_force_W_n = state.contact_force_W_n;
  p.observation.other_contact = state.other_contact;
  p.model->opt.collision = mjCOL_ALL;
  mj_step1(p.model.get(), &d);
  ReadMotion(*p.model, d, p.links, p.hips, p.feet, p.mass_kg, p.observation);
}

}  // namespace footing::physics
