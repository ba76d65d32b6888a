#include "daemon/offline/bench/fann_network.h"

namespace footing::bench {

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

}  // namespace footing::bench
