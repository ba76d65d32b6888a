#pragma once

#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/model/model.h"
#include "common/virtual/motion/motion.h"
#include "daemon/offline/learning/pose_regression.h"

namespace footing::train {

/// A motion file, aligned, and whose it is.
struct Clip {
  std::string name;     ///< Name of the file, without its folder.
  std::string subject;  ///< The name up to the first '_': "13" of 13_29.amc.
  model::DataFile file;
  motion::Motion motion;
  body::Body body;
};

/// Both feet stay within 40 cm of where they mostly are, and the hips above half their height in
/// the T-pose: motion that two boards can be under.
bool StaysInPlace(const Clip& clip);

/// Folders of motion files, and subjects to leave out.
struct MotionOptions {
  std::vector<std::string> folders;
  std::vector<std::string> exclude;  ///< Subjects.
};

void AddMotionOptions(CLI::App& command, MotionOptions& options);

/// Motions for training, and those held back.
struct Clips {
  std::vector<Clip> train;
  std::vector<Clip> excluded;  ///< Clips of the excluded subjects: to test on, never to train on.
  std::vector<std::string> subjects;  ///< Subjects in `train`.
};

/// One .bvh, .amc, .trc or .c3d; an AMC's skeleton is looked for beside it if none is given.
Result<Clip> ReadClip(const std::string& file, const std::string& skeleton = "");

/// Fits a clip of another layout to the standard one. Returns the residual, m; 0 for the standard.
Result<double> FitToStandardLayout(Clip& clip);

/// "1, 13, HDM_bd", for an error.
std::string Listed(const std::set<std::string>& subjects);

/// Every *.bvh, *.amc, *.trc and *.c3d of the folders, by name. An AMC file's skeleton is
/// SUBJECT.asf beside it, or else the first SUBJECT_*.asf; who stands still in SUBJECT_still.trc or
/// .c3d is the person of the marker files of that subject. Where layouts differ, those to train on
/// are fitted to the standard one. An error names the file; folders without a file to train on are
/// one too.
Result<Clips> ReadClips(const MotionOptions& options);

/// The data files of a model: those of the training.
std::vector<model::DataFile> DataFiles(const std::vector<Clip>& clips);

/// A basis of poses, with the number of poses that it is computed from.
struct TrainedBasis {
  learning::PoseBasis basis;
  Eigen::Index poses = 0;
};

/// Basis of the clips and their mirror images, on the ground, all persons as if their roots were 1
/// m high in the T-pose. All clips must have one layout: the error names the first that has not.
Result<TrainedBasis> TrainBasis(const std::vector<Clip>& clips);

/// The basis' tensors and the height of its people.
void AppendBasis(const learning::PoseBasis& basis, model::Model& model);

}  // namespace footing::train
