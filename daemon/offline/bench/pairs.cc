#include "daemon/offline/bench/pairs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <list>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>
#include <Eigen/Core>
#include <Eigen/QR>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>
#include <boost/math/quadrature/gauss.hpp>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/net/framing.h"
#include "common/net/listener.h"
#include "common/net/tls_context.h"
#include "common/runtime/clock.h"
#include "common/statistics/dunnett.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/motion.h"
#include "daemon/offline/bench/waiting.h"
#include "daemon/offline/compute/momentum_cost.h"
#include "daemon/offline/eval/gait_ground.h"
#include "daemon/offline/eval/spirals.h"
#include "daemon/offline/learning/cascade.h"
#include "daemon/offline/learning/horizontal_com.h"
#include "daemon/offline/learning/mlp.h"
#include "daemon/offline/learning/pose_regression.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::bench {

Row RunPairs(const std::string& name, const std::string& unit, int pairs,
             const std::function<double()>& ours, const std::function<double()>& baseline) {
  ours();  // The first run of each warms caches and branch predictors and is not counted.
  baseline();
  std::vector<double> a;
  std::vector<double> b;
  std::vector<double> ratios;
  for (int pair = 0; pair < pairs; ++pair) {
    const bool ours_first = pair % 2 == 0;
    if (ours_first) a.push_back(ours());
    b.push_back(baseline());
    if (!ours_first) a.push_back(ours());
    ratios.push_back(b.back() > 0 ? a.back() / b.back() : 0);
  }
  return {name, text::Median(a), text::Median(b), text::Median(ratios), unit};
}

namespace {

constexpr int kKinematicsPairs = 15;
constexpr int kPoses = 64;
constexpr int kEvaluations = 20'000;  // A run: some 50 ms.
constexpr double kPersonHeightM = 1.75;

struct Poses {
  Eigen::MatrixXd q, q_dot;

  explicit Poses(int dof) : q(dof, kPoses), q_dot(dof, kPoses) {
    noise::Random random(1);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q(i) = random.Uniform(-1, 1);
      q_dot(i) = random.Uniform(-3, 3);
    }
  }
};

/// Microseconds of CPU time for one call.
template <typename F>
double CostUs(F evaluate) {
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  for (int i = 0; i < kEvaluations; ++i) evaluate(i % kPoses);
  return static_cast<double>(clock::ThreadCpuNs() - begin_ns) / 1e3 / kEvaluations;
}

}  // namespace

Result<Rows> BodyKinematics() {
  body::PersonParameters person;
  person.height_m = kPersonHeightM;
  const auto body = body::MakeBody(body::StandardPerson(kPersonHeightM), person);
  if (!body) return body.error();
  const body::Skeleton& skeleton = body->skeleton;
  const Poses poses(skeleton.dof);
  body::Kinematics at(skeleton);
  body::JointVelocities velocities(skeleton);
  body::CompositeMasses workspace(skeleton);
  body::CentroidalMatrix matrix(6, skeleton.dof);
  volatile double kept = 0;  // So that nothing is left out.
  const auto momentum = [&] {
    return CostUs([&](int pose) {
      body::ComputeKinematics(skeleton, poses.q.col(pose), at);
      body::ComputeVelocities(skeleton, at, poses.q_dot.col(pose), velocities);
      kept = body::ComputeMomentum(*body, at, velocities).angular_W.x();
    });
  };
  const auto centroidal = [&] {
    return CostUs([&](int pose) {
      body::ComputeKinematics(skeleton, poses.q.col(pose), at);
      body::ComputeCentroidalMatrix(*body, at, workspace, matrix);
      kept = matrix(3, 7);
    });
  };
  // Lower bound for any forward kinematics: the sines and cosines alone.
  const auto sines = [&] {
    return CostUs([&](int pose) {
      double sum = 0;
      for (int dof = 3; dof < skeleton.dof; ++dof) {
        sum += std::sin(poses.q(dof, pose)) * std::cos(poses.q(dof, pose));
      }
      kept = sum;
    });
  };
  return Rows{
      RunPairs("body_kinematics_com_momentum_us", "us (baseline: the angles' sines and cosines)",
               kKinematicsPairs, momentum, sines),
      RunPairs("body_centroidal_matrix_us", "us (baseline: the angles' sines and cosines)",
               kKinematicsPairs, centroidal, sines)};
}

Result<Rows> BipedStep() {
  constexpr int kStepPairs = 15;
  const biped::GaitCommand walk{.gait = stream::Gait::kWalk, .speed_mps = 1.2};
  const biped::GaitCommand run{.gait = stream::Gait::kRun, .speed_mps = 4};
  Rows rows;
  const auto measure = [&rows](const std::string& name, const biped::GaitCommand& command,
                               double push_ns) -> Result<void> {
    auto cost = eval::StepCost::Create(command, {}, push_ns);
    if (!cost) return cost.error();
    rows.push_back(RunPairs(
        name, "us (baseline: bare mj_step)", kStepPairs, [&] { return cost->EngineUs(); },
        [&] { return cost->BareUs(); }));
    return {};
  };
  for (const auto& done :
       {measure("biped_walk_step_us", walk, 0), measure("biped_run_step_us", run, 0),
        measure("biped_run_after_push_step_us", run, 40)}) {
    if (!done) return done.error();
  }
  return rows;
}

namespace {

constexpr int kDunnettPairs = 15;
constexpr int kDunnettGroups = 5;
constexpr std::size_t kDunnettValues = 100;
constexpr double kDunnettConfidence = 0.95;

/// The group at `i` has `fewer` * i values less than 100.
statistics::Groups DunnettGroups(std::size_t fewer) {
  noise::Random random(1);
  statistics::Groups groups;
  for (std::size_t i = 0; i < kDunnettGroups; ++i) {
    statistics::Group& group = groups.emplace_back();
    for (std::size_t k = 0; k < kDunnettValues - fewer * i; ++k) {
      group.values.push_back(0.1 * static_cast<double>(i) + random.Normal());
    }
  }
  return groups;
}

double Phi(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// Two-sided p of one comparison among equal groups: 30 nodes per unit of y in [-12, 12], 20 nodes
/// on 24 pieces of s.
double GaussP(double t, double degrees, double treatments) {
  using boost::math::quadrature::gauss;
  const double loading = 1 / std::numbers::sqrt2;
  const auto given_s = [&](double s) {
    double sum = 0;
    for (int piece = -12; piece < 12; ++piece) {
      sum += gauss<double, 30>::integrate(
          [&](double y) {
            const double inside =
                Phi((t * s - loading * y) / loading) - Phi((-t * s - loading * y) / loading);
            return std::exp(-y * y / 2) * (1 - std::pow(inside, treatments));
          },
          piece, piece + 1);
    }
    return sum / std::sqrt(2 * std::numbers::pi);
  };
  const double half = degrees / 2;
  const double log_constant = std::log(2) + half * std::log(half) - std::lgamma(half);
  const double reach = 8 / std::sqrt(2 * degrees), step = 2 * reach / 24;
  double p = 0;
  for (int piece = 0; piece < 24; ++piece) {
    const double from = 1 - reach + piece * step;
    p += gauss<double, 20>::integrate(
        [&](double s) {
          return std::exp(log_constant + (degrees - 1) * std::log(s) - half * s * s) * given_s(s);
        },
        from, from + step);
  }
  return p;
}

template <typename Function>
double CostMs(const Function& function) {
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  function();
  return static_cast<double>(clock::ThreadCpuNs() - begin_ns) / 1e6;
}

}  // namespace

Result<Rows> DunnettTest() {
  const statistics::Groups equal = DunnettGroups(0), unequal = DunnettGroups(7);
  constexpr auto kBoth = statistics::Alternative::kTwoSided;
  const auto reference = statistics::DunnettTest(equal, kBoth, kDunnettConfidence);
  if (!reference) return reference.error();
  double difference = 0;
  const auto ours = [&](const statistics::Groups& groups) {
    return CostMs([&] {
      const auto test = statistics::DunnettTest(groups, kBoth, kDunnettConfidence);
      if (!test) difference = 1;
    });
  };
  const auto gauss = [&] {
    return CostMs([&] {
      for (const statistics::DunnettRow& row : reference->rows) {
        const double p = GaussP(std::abs(row.t), reference->degrees, kDunnettGroups - 1);
        difference = std::max(difference, std::abs(p - row.p));
      }
    });
  };
  const char* const unit = "ms CPU (baseline: the p alone, of equal groups, by Gauss nodes)";
  Rows rows = {
      RunPairs(
          "dunnett_5x100_ms", unit, kDunnettPairs, [&] { return ours(equal); }, gauss),
      RunPairs(
          "dunnett_5_unequal_ms", unit, kDunnettPairs, [&] { return ours(unequal); }, gauss)};
  if (difference > 1e-10) return Failure("Dunnett's p differs from that by Gauss nodes");
  return rows;
}

namespace {

using reconstruction::Features;
using reconstruction::Inputs;

constexpr int kPosePairs = 15, kPaperPairs = 5;
constexpr double kHeightM = 1.75, kRateHz = 60;
constexpr double kStandS = 6, kMoveS = 20;
constexpr int kWays = 12;      // Independent ways to move,
constexpr double kWay = 0.06;  // and how far, rad.
constexpr int kWaves = 500;    // As many as a trained model has.

/// A T-pose, then all joints move to and fro, each way with its own frequency.
motion::Motion Moving(const body::Body& body) {
  noise::Random random(1);
  Eigen::MatrixXd ways(body.skeleton.dof, kWays);
  for (double& value : ways.reshaped()) value = kWay * random.Normal();
  ways.topRows<3>() *= 0.2;
  motion::Motion motion;
  motion.skeleton = body.skeleton;
  motion.rate_hz = kRateHz;
  motion.q.resize(body.skeleton.dof, static_cast<Eigen::Index>((kStandS + kMoveS) * kRateHz));
  const Eigen::VectorXd t_pose = body::TPose(body.skeleton, body.landmarks);
  for (Eigen::Index i = 0; i < motion.q.cols(); ++i) {
    const double t = std::max(0.0, static_cast<double>(i) / kRateHz - kStandS);
    motion.q.col(i) = t_pose;
    for (int way = 0; way < kWays; ++way) {
      motion.q.col(i) += (1 - std::cos((1 + 0.3 * way) * t)) / 2 * ways.col(way);
    }
  }
  return motion;
}

std::vector<Inputs> Measured(const body::Body& body, const motion::Motion& motion) {
  const virtual_sensors::BodyCourse course = virtual_sensors::Follow(body, motion);
  const virtual_sensors::GroundReaction reaction = virtual_sensors::React(course);
  auto boards = virtual_sensors::SideBySide();
  for (std::size_t f = 0; f < boards.size(); ++f) {
    boards[f].middle_m = course.sole_m[f][0].col(0).head<2>();
  }
  body::Kinematics at(body.skeleton);
  std::vector<Inputs> all(static_cast<std::size_t>(motion.frames()));
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    Inputs& inputs = all[static_cast<std::size_t>(i)];
    inputs.loads.time_s = static_cast<double>(i) / kRateHz;
    const auto feet = virtual_sensors::ShareBetweenFeet(course, reaction, i);
    for (std::size_t f = 0; f < boards.size(); ++f) {
      const auto places = virtual_sensors::SensorPlaces(boards[f]);
      const auto load = virtual_sensors::LoadBoard(boards[f], feet[f]);
      inputs.loads.feet[f].valid = true;
      inputs.loads.feet[f].count = places.size();
      for (std::size_t k = 0; k < places.size(); ++k) {
        inputs.loads.feet[f].cells[k] = {{places[k].x(), places[k].y(), 0}, load.corners_n[k]};
      }
    }
    body::ComputeKinematics(body.skeleton, motion.q.col(i), at);
    for (int side = 0; side < 2; ++side) {
      reconstruction::HandInput& hand = inputs.hands[static_cast<std::size_t>(side)];
      hand.valid = true;
      hand.p_W_m = body::Place(body::Fist(body, side), at);
    }
  }
  return all;
}

/// Untrained models of a trained model's sizes; they output the T-pose with a small tremble.
reconstruction::Models Trained(const body::Body& body, const motion::Motion& motion) {
  const int dof = body.skeleton.dof;
  noise::Random random(2);
  const auto noise = [&](Eigen::Index rows, Eigen::Index columns, double sd) {
    Eigen::MatrixXd m(rows, columns);
    for (double& value : m.reshaped()) value = sd * random.Normal();
    return m;
  };
  reconstruction::Models models;
  models.dofs = body::DofNames(body.skeleton);
  models.origin = "made";
  models.basis = pose::FitBasis(motion.q + noise(dof, motion.q.cols(), 0.02), {});
  models.rest = models.basis;
  const Eigen::VectorXd t_pose = body::TPose(body.skeleton, body.landmarks);
  models.root_height_m = t_pose(2);
  models.regression.mean = Eigen::VectorXd::Zero(Features::kCount);
  models.regression.scale = Eigen::VectorXd::Ones(Features::kCount);
  models.regression.weights = noise(dof, Features::kCount, 1e-3);
  models.regression.offset = t_pose;
  models.regression.offset.head<3>().setZero();
  const Eigen::MatrixXf waves = noise(kWaves, Features::kCount, 0.1).cast<float>();
  models.regression.waves = reconstruction::StripMatrix(waves);
  models.regression.phases = noise(kWaves, 1, 1).cast<float>();
  const Eigen::MatrixXf wave_weights = noise(dof, kWaves, 1e-3).cast<float>();
  models.regression.wave_weights = reconstruction::StripMatrix(wave_weights);
  return models;
}

/// Poses about the T-pose of which as many components hold 99 % of the variance as of recorded
/// ones (docs/models.md): the search of paper mode costs by their number.
pose::PoseBasis FallingBasis(const body::Body& body) {
  constexpr int kHold99Percent = 27, kPoses = 2000;
  const int dof = body.skeleton.dof;
  noise::Random random(3);
  Eigen::MatrixXd directions(dof, dof), poses(dof, kPoses);
  for (double& value : directions.reshaped()) value = random.Normal();
  directions = Eigen::HouseholderQR<Eigen::MatrixXd>(directions).householderQ();
  for (double& value : poses.reshaped()) value = random.Normal();
  // Variances fall evenly by such a factor that the 27 first hold all but 1 %.
  for (int i = 0; i < dof; ++i) poses.row(i) *= 0.3 * std::pow(0.01, 0.5 * i / kHold99Percent);
  pose::BasisOptions options;
  options.translation_weight = 1;
  poses = directions * poses;
  poses.colwise() += body::TPose(body.skeleton, body.landmarks);
  return pose::FitBasis(poses, options);
}

/// The same with the networks of the horizontal COM and without the regression.
reconstruction::Models OfPaper(const body::Body& body, const motion::Motion& motion) {
  reconstruction::Models models = Trained(body, motion);
  models.basis = FallingBasis(body);
  const std::vector<learning::LoadClip> clips{learning::MakeSway({.seconds = 20}, 1)};
  learning::CascadeOptions options;
  options.hidden_max = options.hidden_min = 0;
  const auto network = [&](int axis) {
    const learning::Examples examples = learning::HorizontalExamples(clips, axis);
    return learning::TrainCascade(examples, examples, options, 1).network;
  };
  models.horizontal = {network(0), network(1)};
  return models;
}

/// Cost of a mode's frames, once its T-pose is over.
struct Bench {
  body::Body body;
  motion::Motion motion;
  std::vector<Inputs> all;

  static std::size_t MovesFrom() { return static_cast<std::size_t>(kStandS * kRateHz); }

  Result<reconstruction::Reconstruction> Standing(reconstruction::Mode mode,
                                                  const reconstruction::Models& models) const {
    reconstruction::Options options;
    options.rate_hz = kRateHz;
    options.mode = mode;
    auto standing = reconstruction::Reconstruction::Create(body, models, options);
    if (!standing) return standing;
    for (std::size_t i = 0; i < MovesFrom(); ++i) standing->Advance(all[i]);
    if (!standing->output().calibrated) return InvalidData("the made T-pose did not stand still");
    return standing;
  }

  double FrameUs(const reconstruction::Reconstruction& standing, double quantile) const {
    reconstruction::Reconstruction moving = standing;
    std::vector<double> spent_us;
    for (std::size_t i = MovesFrom(); i < all.size(); ++i) {
      const std::int64_t begin_ns = clock::ThreadCpuNs();
      moving.Advance(all[i]);
      spent_us.push_back(static_cast<double>(clock::ThreadCpuNs() - begin_ns) / 1e3);
    }
    return text::Quantile(std::move(spent_us), quantile);
  }

  Rows Measure(const std::string& name, const reconstruction::Reconstruction& standing,
               int pairs) const {
    const auto unit_us = [&] {
      return timing::MomentumCostUs(body, motion.q.col(motion.frames() - 1));
    };
    const char* const unit = "us (baseline: forward kinematics, centre of mass and momentum once)";
    const auto row = [&](const char* ending, double quantile) {
      return RunPairs(
          name + ending, unit, pairs, [&] { return FrameUs(standing, quantile); }, unit_us);
    };
    return {row("_p50_us", 0.5), row("_p99_us", 0.99)};
  }
};

}  // namespace

Result<Rows> PoseFrame() {
  body::PersonParameters person;
  person.height_m = kHeightM;
  auto body = body::MakeBody(body::StandardPerson(kHeightM), person);
  if (!body) return body.error();
  const motion::Motion motion = Moving(*body);
  const Bench bench{*body, motion, Measured(*body, motion)};
  const auto best = bench.Standing(reconstruction::Mode::kBest, Trained(*body, motion));
  if (!best) return best.error();
  const auto paper = bench.Standing(reconstruction::Mode::kPaper, OfPaper(*body, motion));
  if (!paper) return paper.error();
  Rows rows = bench.Measure("pose_frame", *best, kPosePairs);
  const Rows of_paper = bench.Measure("pose_frame_paper", *paper, kPaperPairs);
  rows.insert(rows.end(), of_paper.begin(), of_paper.end());
  return rows;
}

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr int kTlsPairs = 9;
constexpr int kConnects = 60;
constexpr int kRoundTrips = 3000;
constexpr std::size_t kEchoBytes = 100;

/// Ours: frames over a Listener's sockets, sent back; in turns, as a server's sessions are.
class FramedEcho {
 public:
  FramedEcho(asio::io_context& io, const tls::Identity& identity) : io_(io), identity_(identity) {
    loop_.turns = std::make_shared<transport::TurnQueue>(io.get_executor());
  }

  Result<void> Listen() {
    transport::Address address = TcpAddress();
    address.kind = transport::Address::Kind::kTls;
    transport::ListenSecurity security;
    security.tls = [this] { return tls::Context::ForServer(identity_); };
    auto listener = transport::Listener::Open(
        io_, address, [this](transport::Socket socket) { Accept(std::move(socket)); }, security);
    if (!listener) return listener.error();
    listener_ = std::move(*listener);
    return {};
  }
  const transport::Address& address() const { return listener_->address(); }

 private:
  void Accept(transport::Socket socket) {
    const auto place = connections_.emplace(connections_.end());
    transport::FramedHandlers handlers;
    handlers.on_frame = [place](std::string_view payload) { (*place)->Send(payload); };
    handlers.on_close = [this, place](const std::string&) { connections_.erase(place); };
    place->emplace(std::move(socket), transport::FramedLimits(), std::move(handlers), loop_);
    (*place)->Start();
  }

  asio::io_context& io_;
  const tls::Identity& identity_;
  transport::SharedLoop loop_;
  std::unique_ptr<transport::Listener> listener_;
  std::list<std::optional<transport::FramedConnection>> connections_;
};

/// The baseline: Asio's own TLS stream, one frame of known length at a time; the same certificate,
/// TLS 1.3, no tickets.
class BareEcho {
 public:
  BareEcho(asio::io_context& io, const std::string& identity_file)
      : acceptor_(io, {asio::ip::address_v4::loopback(), 0}), context_(asio::ssl::context::tlsv13) {
    context_.use_certificate_chain_file(identity_file);
    context_.use_private_key_file(identity_file, asio::ssl::context::pem);
    SSL_CTX_set_num_tickets(context_.native_handle(), 0);
    Accept();
  }
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  struct Connection {
    Connection(tcp::socket socket, asio::ssl::context& context)
        : stream(std::move(socket), context), frame(kEchoBytes + transport::kLengthBytes, '\0') {}
    asio::ssl::stream<tcp::socket> stream;
    std::string frame;
  };

  void Accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (error) return;
      socket.set_option(tcp::no_delay(true));
      const auto connection = std::make_shared<Connection>(std::move(socket), context_);
      connection->stream.async_handshake(asio::ssl::stream_base::server,
                                         [connection](const error_code& failed) {
                                           if (!failed) Echo(connection);
                                         });
      Accept();
    });
  }

  static void Echo(const std::shared_ptr<Connection>& connection) {
    const auto buffer = asio::buffer(connection->frame);
    asio::async_read(connection->stream, buffer,
                     [connection, buffer](const error_code& error, std::size_t) {
                       if (error) return;
                       asio::async_write(connection->stream, buffer,
                                         [connection](const error_code& failed, std::size_t) {
                                           if (!failed) Echo(connection);
                                         });
                     });
  }

  tcp::acceptor acceptor_;
  asio::ssl::context context_;
};

/// When an exchange began, then when each of its echoes arrived.
using Stamps = std::vector<std::int64_t>;

/// One connection of ours: `echoes` frames, each sent when the one before has come back.
class FramedExchange {
 public:
  FramedExchange(asio::io_context& io, const transport::Address& address, std::size_t echoes,
                 std::function<void()> done)
      : echoes_(echoes), done_(std::move(done)), stamps_{clock::MonotonicNs()} {
    transport::Dial(io, address, [this](Result<transport::Socket> socket) {
      if (!socket) return done_();
      transport::FramedHandlers handlers;
      handlers.on_frame = [this](std::string_view payload) {
        stamps_.push_back(clock::MonotonicNs());
        stamps_.size() > echoes_ ? done_() : static_cast<void>(connection_->Send(payload));
      };
      handlers.on_close = [this](const std::string&) { done_(); };
      connection_.emplace(std::move(*socket), transport::FramedLimits(), std::move(handlers));
      connection_->Start();
      connection_->Send(std::string(kEchoBytes, 'e'));
    });
  }
  const Stamps& stamps() const { return stamps_; }

 private:
  const std::size_t echoes_;
  std::function<void()> done_;
  Stamps stamps_;
  std::optional<transport::FramedConnection> connection_;
};

/// The same with Asio alone.
class BareExchange {
 public:
  BareExchange(asio::io_context& io, asio::ssl::context& context, std::uint16_t port,
               std::size_t echoes, std::function<void()> done)
      : echoes_(echoes),
        done_(std::move(done)),
        stamps_{clock::MonotonicNs()},
        stream_(io, context),
        frame_(transport::Frame(std::string(kEchoBytes, 'e'))) {
    stream_.next_layer().async_connect({asio::ip::address_v4::loopback(), port},
                                       [this](const error_code& error) {
                                         if (error) return done_();
                                         stream_.next_layer().set_option(tcp::no_delay(true));
                                         ShakeHands();
                                       });
  }
  const Stamps& stamps() const { return stamps_; }

 private:
  void ShakeHands() {
    stream_.async_handshake(asio::ssl::stream_base::client,
                            [this](const error_code& error) { error ? done_() : Send(); });
  }
  void Send() {
    asio::async_write(stream_, asio::buffer(frame_), [this](const error_code& error, std::size_t) {
      error ? done_() : Receive();
    });
  }
  void Receive() {
    asio::async_read(stream_, asio::buffer(frame_), [this](const error_code& error, std::size_t) {
      if (!error) stamps_.push_back(clock::MonotonicNs());
      error || stamps_.size() > echoes_ ? done_() : Send();
    });
  }

  const std::size_t echoes_;
  std::function<void()> done_;
  Stamps stamps_;
  asio::ssl::stream<tcp::socket> stream_;
  std::string frame_;
};

/// Makes an exchange on the thread and waits for its end.
template <typename Exchange, typename... Arguments>
Stamps StampsOf(LoopThread& thread, std::size_t echoes, Arguments&... arguments) {
  std::optional<Exchange> exchange;
  std::promise<void> over;
  bool done = false;
  thread.Do([&] {
    exchange.emplace(thread.io(), arguments..., echoes, [&] {
      if (!std::exchange(done, true)) over.set_value();
    });
  });
  over.get_future().wait();
  Stamps stamps;
  thread.Do([&] {
    stamps = exchange->stamps();
    exchange.reset();
  });
  return stamps;
}

double MedianUs(const std::vector<double>& times_ns) {
  return times_ns.empty() ? 0 : 1e-3 * text::Quantile(times_ns, 0.5);
}

/// From the dial until the first echo: connection, handshake, and one round trip.
double MedianConnectUs(const std::function<Stamps(std::size_t echoes)>& exchange) {
  std::vector<double> times_ns;
  for (int i = 0; i < kConnects; ++i) {
    const Stamps stamps = exchange(1);
    if (stamps.size() == 2) times_ns.push_back(static_cast<double>(stamps[1] - stamps[0]));
  }
  return MedianUs(times_ns);
}

double MedianRoundTripUs(const std::function<Stamps(std::size_t echoes)>& exchange) {
  const Stamps stamps = exchange(kRoundTrips);
  std::vector<double> times_ns;
  for (std::size_t i = 2; i < stamps.size(); ++i) {
    times_ns.push_back(static_cast<double>(stamps[i] - stamps[i - 1]));
  }
  return MedianUs(times_ns);
}

}  // namespace

Result<Rows> TlsExchange() {
  const std::string folder = "/tmp/footing-bench-" + std::to_string(getpid()) + "-tls";
  setenv("FOOTING_KNOWN_SERVERS", (folder + "/known_servers").c_str(), 1);
  const std::string identity_file = folder + "/identity.pem";
  const auto identity = tls::Identity::LoadOrMake(identity_file, "footing-bench");
  if (!identity) return identity.error();
  LoopThread server_thread, client_thread;
  FramedEcho framed(server_thread.io(), *identity);
  BareEcho bare(server_thread.io(), identity_file);
  asio::ssl::context bare_context(asio::ssl::context::tlsv13_client);
  const StopsAtEnd stops{&server_thread, &client_thread};
  Result<void> listening;
  server_thread.Do([&] { listening = framed.Listen(); });
  if (!listening) return listening.error();
  const transport::Address address = framed.address();
  const std::uint16_t port = bare.port();
  const auto ours = [&](std::size_t echoes) {
    return StampsOf<FramedExchange>(client_thread, echoes, address);
  };
  const auto baseline = [&](std::size_t echoes) {
    return StampsOf<BareExchange>(client_thread, echoes, bare_context, port);
  };
  if (ours(1).size() != 2 || baseline(1).size() != 2) {
    return Failure("tls_connect: the echo did not come back");
  }
  const Row connect = RunPairs(
      "tls_connect_p50", "us", kTlsPairs, [&] { return MedianConnectUs(ours); },
      [&] { return MedianConnectUs(baseline); });
  const Row round_trip = RunPairs(
      "tls_round_trip_p50", "us", kTlsPairs, [&] { return MedianRoundTripUs(ours); },
      [&] { return MedianRoundTripUs(baseline); });
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return Rows{connect, round_trip};
}

FannData ToFann(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& targets) {
  FannData data(
      fann_create_train(static_cast<unsigned>(inputs.rows()), static_cast<unsigned>(inputs.cols()),
                        static_cast<unsigned>(targets.cols())),
      &fann_destroy_train);
  for (Eigen::Index row = 0; row < inputs.rows(); ++row) {
    Eigen::RowVectorXf::Map(data->input[row], inputs.cols()) = inputs.row(row).cast<float>();
    Eigen::RowVectorXf::Map(data->output[row], targets.cols()) = targets.row(row).cast<float>();
  }
  return data;
}

namespace {

using learning::Examples;

constexpr int kAxes = 2;
constexpr int kHidden = 20;       // Hidden units of FANN's network; the most of ours.
constexpr double kNoiseM = 0.01;  // On the fed-back COM, without which the closed loop diverges.

/// One axis: 84 s at 60 Hz to train on, as much to choose by, as much to test with.
struct Axis {
  Examples train, validation, fresh;
};

Axis MakeAxis(int axis) {
  const learning::FeedbackNoise noise{.groups = learning::FeedbackColumns(),
                                      .common_sd = kNoiseM,
                                      .own_sd = kNoiseM / 10,
                                      .copies = 1};
  const auto examples = [&](std::uint64_t seed) {
    const learning::LoadClip clip = learning::MakeSway({}, seed);
    return learning::WithFeedbackNoise(learning::HorizontalExamples({&clip, 1}, axis), noise, seed);
  };
  return {.train = examples(1), .validation = examples(2), .fresh = examples(3)};
}

/// CPU seconds, and the mean squared error on the fresh rows.
struct TrainingCost {
  double seconds = 0;
  double mse = 0;
};

double SecondsSince(std::int64_t start_ns) {
  return NanosecondsToSeconds(clock::ThreadCpuNs() - start_ns);
}

TrainingCost Ours(const Axis& axis, int patience, double* validation_mse) {
  learning::CascadeOptions options;
  options.hidden_max = kHidden;
  options.patience = patience;
  const std::int64_t start_ns = clock::ThreadCpuNs();
  const auto result = learning::TrainCascade(axis.train, axis.validation, options, 1);
  *validation_mse = result.validation_mse;
  return {SecondsSince(start_ns), MeanSquaredError(result.network, axis.fresh)};
}

/// Back-propagation until its error of validation equals the cascade's; at most 1000 epochs.
TrainingCost Perceptron(const Axis& axis, double validation_mse) {
  learning::MlpOptions options;
  options.hidden = kHidden;
  options.epochs_max = options.patience = 1000;
  options.mse_goal = validation_mse;
  const std::int64_t start_ns = clock::ThreadCpuNs();
  const auto result = learning::TrainMlp(axis.train, axis.validation, options, 1);
  return {SecondsSince(start_ns), MeanSquaredError(result.network, axis.fresh)};
}

/// FANN's Cascade2 as it comes, with linear outputs, on inputs and targets scaled as ours are.
TrainingCost Fann(const Axis& axis) {
  const auto in = learning::Scaling::Of(axis.train.inputs);
  const auto out = learning::Scaling::Of(axis.train.targets);
  const FannData train = ToFann(in.Apply(axis.train.inputs), out.Apply(axis.train.targets));
  const FannNetwork network(
      fann_create_shortcut(2, static_cast<unsigned>(axis.train.inputs.cols()), 1), &fann_destroy);
  fann_set_activation_function_hidden(network.get(), FANN_SIGMOID_SYMMETRIC);
  fann_set_activation_function_output(network.get(), FANN_LINEAR);
  fann_set_train_error_function(network.get(), FANN_ERRORFUNC_LINEAR);
  fann_set_training_algorithm(network.get(), FANN_TRAIN_RPROP);
  const std::int64_t start_ns = clock::ThreadCpuNs();
  fann_cascadetrain_on_data(network.get(), train.get(), kHidden, 0, 1e-7f);
  TrainingCost measured{SecondsSince(start_ns), 0};

  const FannData fresh = ToFann(in.Apply(axis.fresh.inputs), out.Apply(axis.fresh.targets));
  for (Eigen::Index row = 0; row < axis.fresh.rows(); ++row) {
    const double error = *fann_run(network.get(), fresh->input[row]) - *fresh->output[row];
    measured.mse += error * error / (out.scale(0) * out.scale(0));
  }
  measured.mse /= static_cast<double>(axis.fresh.rows());
  return measured;
}

Row MakeRow(const std::string& name, double ours, double baseline, const std::string& unit) {
  return {.name = name, .ours = ours, .baseline = baseline, .ratio = ours / baseline, .unit = unit};
}

double Rms(double mse_sum_m2) { return 1e3 * std::sqrt(mse_sum_m2 / kAxes); }

}  // namespace

Result<Rows> CascadeTraining() {
  TrainingCost ours, all_units, perceptron, baseline;
  const auto add = [](TrainingCost& sum, const TrainingCost& one) {
    sum.seconds += one.seconds;
    sum.mse += one.mse;
  };
  for (int axis = 0; axis < kAxes; ++axis) {
    const Axis data = MakeAxis(axis);
    double validation_mse = 0;
    add(all_units, Ours(data, kHidden + 1, &validation_mse));
    add(ours, Ours(data, learning::CascadeOptions{}.patience, &validation_mse));
    add(perceptron, Perceptron(data, validation_mse));
    add(baseline, Fann(data));
  }
  return Rows{
      MakeRow("cascade_training", ours.seconds, baseline.seconds, "s"),
      MakeRow("cascade_training_20_units", all_units.seconds, baseline.seconds, "s"),
      MakeRow("cascade_error", Rms(ours.mse), Rms(baseline.mse), "mm"),
      MakeRow("cascade_error_20_units", Rms(all_units.mse), Rms(baseline.mse), "mm"),
      MakeRow("cascade_training_and_perceptron", ours.seconds, perceptron.seconds, "s"),
      MakeRow("cascade_error_and_perceptron", Rms(ours.mse), Rms(perceptron.mse), "mm"),
  };
}

namespace {

constexpr int kPairs = 31;  // FANN draws its weights unseeded: its times vary by a factor of 3.
constexpr int kRuns = kPairs + 1;  // The first of each warms up.
constexpr int kDenser = 4;
constexpr unsigned kMostHidden = 40;
constexpr float kGoal = 0.0005f;  // Mean squared error of targets of +-1: every point is right.

struct SpiralTraining {
  double seconds = 0;
  double wrong = 0;  ///< Part of spirals four times as dense.
};

/// Cascade2 of FANN as it comes, with an output that reaches the targets.
SpiralTraining Fann() {
  const learning::Examples spirals = learning::TwoSpirals();
  const FannData train = ToFann(spirals.inputs, 2 * spirals.targets);
  const FannNetwork network(fann_create_shortcut(2, 2, 1), &fann_destroy);
  fann_set_activation_function_output(network.get(), FANN_SIGMOID_SYMMETRIC);
  fann_set_training_algorithm(network.get(), FANN_TRAIN_RPROP);
  const std::int64_t start_ns = clock::ThreadCpuNs();
  fann_cascadetrain_on_data(network.get(), train.get(), kMostHidden, 0, kGoal);
  SpiralTraining result{.seconds = NanosecondsToSeconds(clock::ThreadCpuNs() - start_ns)};

  const learning::Examples dense = learning::TwoSpirals(kDenser);
  const FannData between = ToFann(dense.inputs, dense.targets);
  for (Eigen::Index row = 0; row < dense.rows(); ++row) {
    const float output = *fann_run(network.get(), between->input[row]);
    result.wrong += output * *between->output[row] > 0 ? 0 : 1;
  }
  result.wrong /= static_cast<double>(dense.rows());
  return result;
}

}  // namespace

Result<Rows> SpiralsTraining() {
  std::uint64_t seed = 0;
  double wrong = 0, baseline_wrong = 0;
  const auto ours = [&] {
    const eval::SpiralTrial trial = eval::RunSpiralTrial(eval::SpiralOptions(), ++seed);
    wrong += trial.wrong_between / kRuns;
    return trial.seconds;
  };
  const auto baseline = [&] {
    const SpiralTraining fann = Fann();
    baseline_wrong += fann.wrong / kRuns;
    return fann.seconds;
  };
  const Row cost = RunPairs("spirals_training", "s", kPairs, ours, baseline);
  return Rows{cost, {"spirals_error", wrong, baseline_wrong, wrong / baseline_wrong, ""}};
}

}  // namespace footing::bench
