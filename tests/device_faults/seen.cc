#include "tests/device_faults/seen.h"

#include <google/protobuf/message.h>

#include <algorithm>
#include <cmath>

namespace footing::device_faults {
namespace {

template <typename Map>
const typename Map::mapped_type& At(const Map& map, std::uint32_t number) {
  static const typename Map::mapped_type kNone;
  const auto found = map.find(number);
  return found == map.end() ? kNone : found->second;
}

}  // namespace

template <typename Sample>
void Seen::Keep(const Sample& sample, std::map<std::uint32_t, std::vector<Sample>>& all,
                const char* what) {
  auto& list = all[sample.device()];
  if (sample.sampled_ns() > sample.received_ns()) {
    wrongs_.push_back(std::string(what) + " sample from the future");
  }
  if (!list.empty() && (sample.received_ns() < list.back().received_ns() ||
                        sample.sampled_ns() < list.back().sampled_ns())) {
    wrongs_.push_back(std::string(what) + " samples out of order");
  }
  list.push_back(sample);
}

void Seen::Take(const v1::Tick& tick) {
  CheckNumbers(tick);
  ++ticks_;
  for (const v1::DeviceStatus& status : tick.status().devices()) {
    numbers_[status.serial()] = status.device();
    status_[status.device()] = status;
    auto& notes = notes_[status.device()];
    if (!status.note().empty() &&
        std::find(notes.begin(), notes.end(), status.note()) == notes.end()) {
      notes.push_back(status.note());
    }
  }
  for (const auto& sample : tick.motion().samples()) Keep(sample, motion_, "motion");
  for (const auto& sample : tick.boards().samples()) Keep(sample, boards_, "board");
  for (const auto& sample : tick.nunchuk().samples()) Keep(sample, nunchuk_, "Nunchuk");
  for (const auto& sample : tick.camera().samples()) camera_[sample.device()].push_back(sample);
  for (const auto& report : tick.raw().reports()) raw_[report.device()].push_back(report);
  if (tick.has_features()) {
    v1::Tick kept;
    *kept.mutable_features() = tick.features();
    kept.set_host_ns(tick.host_ns());
    feature_ticks_.push_back(std::move(kept));
  }
}

void Seen::CheckNumbers(const google::protobuf::Message& message) {
  const auto* reflection = message.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const auto* field : fields) {
    using Field = google::protobuf::FieldDescriptor;
    if (field->cpp_type() == Field::CPPTYPE_DOUBLE) {
      const int count = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
      for (int i = 0; i < count; ++i) {
        const double value = field->is_repeated() ? reflection->GetRepeatedDouble(message, field, i)
                                                  : reflection->GetDouble(message, field);
        if (!std::isfinite(value)) wrongs_.push_back(field->full_name() + " is not finite");
      }
    } else if (field->cpp_type() == Field::CPPTYPE_MESSAGE) {
      if (!field->is_repeated()) {
        CheckNumbers(reflection->GetMessage(message, field));
        continue;
      }
      for (int i = 0; i < reflection->FieldSize(message, field); ++i) {
        CheckNumbers(reflection->GetRepeatedMessage(message, field, i));
      }
    }
  }
}

std::uint32_t Seen::Number(const std::string& serial) const {
  const auto found = numbers_.find(serial);
  return found == numbers_.end() ? 0 : found->second;
}

const v1::DeviceStatus* Seen::Status(const std::string& serial) const {
  const auto found = status_.find(Number(serial));
  return found == status_.end() ? nullptr : &found->second;
}

const std::vector<v1::MotionSample>& Seen::Motion(const std::string& serial) const {
  return At(motion_, Number(serial));
}
const std::vector<v1::BoardSample>& Seen::Boards(const std::string& serial) const {
  return At(boards_, Number(serial));
}
const std::vector<v1::NunchukSample>& Seen::Nunchuk(const std::string& serial) const {
  return At(nunchuk_, Number(serial));
}
const std::vector<v1::CameraSample>& Seen::Camera(const std::string& serial) const {
  return At(camera_, Number(serial));
}
const std::vector<v1::RawReport>& Seen::Raw(const std::string& serial) const {
  return At(raw_, Number(serial));
}
const std::vector<std::string>& Seen::Notes(const std::string& serial) const {
  return At(notes_, Number(serial));
}

void Seen::Forget() {
  motion_.clear();
  boards_.clear();
  nunchuk_.clear();
  camera_.clear();
  raw_.clear();
  feature_ticks_.clear();
}

}  // namespace footing::device_faults
