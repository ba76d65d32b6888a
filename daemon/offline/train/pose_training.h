#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "common/base/result.h"
#include "common/model/model.h"
#include "daemon/offline/compute/ranks.h"
#include "daemon/offline/learning/mlp.h"
#include "daemon/offline/learning/pose_regression.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/offline/train/motions.h"
#include "daemon/simulation/reconstruction/models.h"

namespace footing::train {

/// State that all subcommands share.
struct Shared {
  bool json = false;
  std::string command_line;  ///< For the model's provenance.
  int exit_code = 0;         ///< Set by the subcommand that ran.
  ranks::Ranks ranks;        ///< This process is one of them; `people` alone shares its work.
};

/// Each adds one subcommand to footing-train; its callback does the work and sets
/// `shared.exit_code`.
void AddArmCommand(CLI::App& app, Shared& shared);
void AddBasisCommand(CLI::App& app, Shared& shared);
void AddCascadeCommand(CLI::App& app, Shared& shared);
void AddComCommand(CLI::App& app, Shared& shared);
void AddMlpCommand(CLI::App& app, Shared& shared);
void AddPeopleCommand(CLI::App& app, Shared& shared);
void AddPersonCommand(CLI::App& app, Shared& shared);
void AddPoseCommand(CLI::App& app, Shared& shared);

/// Options of every subcommand that writes a model.
struct ModelOptions {
  std::string out;
  bool force = false;
  std::uint64_t seed = 1;
  std::vector<std::string> licences;  ///< Kept by the command line, in the provenance.
};

void AddModelOptions(CLI::App& command, ModelOptions& options);

/// Refuses an `out` that exists, before anything is trained.
Result<void> CheckFree(const ModelOptions& options);

/// A model without tensors, with all that is known of where it comes from.
model::Model NewModel(const std::string& kind, const Shared& shared, const ModelOptions& options,
                      std::vector<model::DataFile> data, std::vector<std::string> subjects);

/// Writes the model file; refuses to replace one without `force`.
Result<void> WriteModel(const model::Model& model, const ModelOptions& options);

/// Writes the model, then the report of it to standard output; the program's exit code.
int Deliver(const model::Model& model, const ModelOptions& options,
            const nlohmann::ordered_json& report, const Shared& shared);

/// How poses are learned from clips: simulated sensors, the reconstruction's own estimators, and a
/// regression on what these say.
inline constexpr double kPosePieceS = 10;        ///< Frames of one piece are left out together.
inline constexpr std::size_t kFewestPeople = 3;  ///< Fewer do not show a next person's errors.
inline constexpr double kSettledS = 1.5;         ///< After the T-pose.

/// A clip, or its mirror image, and how its random errors and pieces are numbered.
struct PoseTake {
  const Clip* clip;
  bool mirrored = false;
  int piece = 0;   ///< Number of its first piece.
  int person = 0;  ///< Number of the clip's subject.
  /// All that a person did is left out together; else pieces are.
  bool by_person = false;
  std::uint64_t seed = 1;
};

/// All clips and their mirror images; a clip and its image are in the same folds: those of people,
/// where there are kFewestPeople of them. `piece` is that of the first, and becomes that after the
/// last.
std::vector<PoseTake> TakesOf(const std::vector<const Clip*>& clips, std::uint64_t seed,
                              int& piece);

/// Measurements of two boards and two hand trackers, and a tracker of the head and a belt
/// where there are such.
Result<pose_run::PoseRun> SimulateTake(const PoseTake& take,
                                       pose_run::HeadDevice head = pose_run::HeadDevice::kNone,
                                       bool belt = false);

/// Appends the take's frames. A take whose T-pose never stands still on the boards adds none; the
/// first pass, that of the posture, warns of it by its name.
Result<void> AddExamples(const PoseTake& take, const reconstruction::Models& models,
                         learning::PoseCues cues, learning::PoseExamples& examples);

/// Fits what is foreseen by `cues` and appends it to the model, which has a basis of this scale.
learning::FittedPoseRegression AppendPoses(const learning::PoseExamples& examples,
                                           learning::PoseCues cues, const Eigen::VectorXd& scale,
                                           std::uint64_t seed, model::Model& model);

/// Options of the subcommands that train on a table.
struct DataOptions {
  std::string data;
  int inputs = 0;
  double validation = 0.2;
  std::vector<std::string> feedback;  ///< Names of columns, comma between; a group an option.
  double noise_sd = 0;
  int copies = 1;
  std::vector<std::string> subjects;
  ModelOptions model;
};

void AddDataOptions(CLI::App& command, DataOptions& options);

/// Rows of a table for training and validation.
struct TrainingData {
  learning::Split split;
  model::DataFile file;
};

/// Reads, checks and splits the table and puts noise on what is fed back, in validation too.
/// Refuses an existing model before anything is trained.
Result<TrainingData> Load(const DataOptions& options);

/// A CSV file's numbers with its columns' names.
struct Table {
  std::vector<std::string> columns;
  Eigen::MatrixXd values;  ///< A row each.
};

/// A CSV text: a line of column names, then numbers within +-1e9 in every cell. Lines that are
/// empty or begin with # are left out. Every error names `origin`, line and what is wrong.
Result<Table> ParseTable(std::string_view text, const std::string& origin);

}  // namespace footing::train
