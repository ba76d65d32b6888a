#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fann.h>
#include <Eigen/Core>

#include "common/base/result.h"

namespace footing::bench {

/// One line of footing-bench: ours against the baseline of the same run.
struct Row {
  std::string name;
  double ours = 0;      ///< Median over the runs of ours, in `unit`.
  double baseline = 0;  ///< Median over the runs of the baseline.
  double ratio = 0;     ///< Median of the pairs' ratios: not the ratio of the medians.
  std::string unit;
};

using Rows = std::vector<Row>;

/// From Server::Publish over a Unix socket, against a bare Asio exchange of the same bytes: until
/// the client has the tick's bytes (like for like), and until its handler has the parsed tick.
Result<Rows> PublishToClient();

/// CPU time of the server's thread for 100 viewers over loopback TCP at 100 Hz with 5 devices,
/// against a bare Asio fan-out of the same bytes.
Result<Rows> FanOutCpu();

/// CPU time of the server for each tick that each of 1000 viewers over loopback TCP gets at 100 Hz,
/// until the last one has it, against bare Asio, and against Debian's mosquitto and nats-server
/// where they are installed; no tick may be lost.
Result<Rows> FanOutThousand();

/// From Server::Publish over a Unix socket until the client's handler has the parsed tick, median
/// and p99, against bare Asio over the same, and against Debian's brokers over loopback TCP where
/// they are installed, with the same parsing behind.
Result<Rows> PublishToHandler();

/// Delay of 20 healthy readers beside 20 stalled ones, against 20 healthy ones alone; and how far
/// the memory grows once ring and queues are full, against 2 MB.
Result<Rows> StalledReaders();

/// From the dial to the first echo over TLS, and one round trip of 100 bytes, against Asio's own
/// TLS stream with the same certificate.
Result<Rows> TlsExchange();

/// Forward kinematics, centre of mass and momentum of the standard person (56 degrees of freedom),
/// and the same with the centroidal momentum matrix, against the sines and cosines of its angles.
Result<Rows> BodyKinematics();

/// CPU time of a frame of the best and the paper mode's reconstruction (the standard person, models
/// of trained ones' sizes, 20 s of synthetic motion), median and p99, against forward kinematics,
/// centre of mass and momentum once.
Result<Rows> PoseFrame();

/// CPU time of a step of the gait engine, walking at 1.2 m/s and running at 4 m/s, and of a run in
/// the two seconds after a push of 40 N s, with its rollouts; each against bare mj_step under the
/// same forces.
Result<Rows> BipedStep();

/// Training the networks of the horizontal COM, both axes of 84 s at 60 Hz, against Cascade2 of
/// FANN and against back-propagation to the same error: CPU seconds, and the root mean square error
/// on a recording that none has seen. One run of each, for FANN takes minutes. Only where libfann
/// is installed.
Result<Rows> CascadeTraining();

/// Training on the two spirals, 32 seeds, against Cascade2 of FANN: CPU seconds, and the part of
/// spirals four times as dense that is wrong. Only where libfann is installed.
Result<Rows> SpiralsTraining();

/// Dunnett's test of five groups of 100 with its simultaneous intervals, equal and unequal sizes,
/// against the same p by Gauss-Legendre nodes.
Result<Rows> DunnettTest();

/// Runs ours and the baseline in turn (A B B A A B B A ...), so that a slow drift of the machine
/// falls on both alike. Each call returns one figure, larger is worse.
Row RunPairs(const std::string& name, const std::string& unit, int pairs,
             const std::function<double()>& ours, const std::function<double()>& baseline);

using FannData = std::unique_ptr<fann_train_data, decltype(&fann_destroy_train)>;
using FannNetwork = std::unique_ptr<fann, decltype(&fann_destroy)>;

/// A row an example.
FannData ToFann(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& targets);

}  // namespace footing::bench
