#pragma once

#include <fann.h>

#include <Eigen/Core>
#include <memory>

namespace footing::bench {

using FannData = std::unique_ptr<fann_train_data, decltype(&fann_destroy_train)>;
using FannNetwork = std::unique_ptr<fann, decltype(&fann_destroy)>;

/// A row an example.
FannData ToFann(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& targets);

}  // namespace footing::bench
