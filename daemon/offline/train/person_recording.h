#pragma once

#include <map>
#include <set>
#include <string>

#include "common/base/result.h"
#include "common/model/model.h"
#include "common/runtime/subject.h"
#include "daemon/offline/learning/person_fit.h"
#include "daemon/simulation/pose_service/publish.h"
#include "daemon/simulation/reconstruction/models.h"
#include "footing/v1/character.pb.h"

namespace footing::train {

/// Frames of one subject of the pose engine in a recording of footing-sim.
struct PersonRecording {
  subject::Subject subject;
  model::DataFile file;
  std::map<std::uint64_t, pose_service::PoseApplied> inputs;  ///< By the step that they apply from.
  std::map<std::uint64_t, v1::Character> frames;              ///< As published, by step.
};

/// The frames of the subject of this code; of the last one when it is empty. InvalidData: no frame
/// of the pose engine, none of this subject, paper mode, or a lag.
Result<PersonRecording> ReadPersonRecording(const std::string& path, const std::string& code);

/// Gives boards and hands alone to a new engine, step by step, and adds what these show beside the
/// pose that was published. Returns the seconds that were added. InvalidData when the recording has
/// no T-pose, or no hands.
Result<double> AddPersonRecording(const PersonRecording& recording,
                                  const reconstruction::Models& models,
                                  learning::PersonExamples& examples);

}  // namespace footing::train
