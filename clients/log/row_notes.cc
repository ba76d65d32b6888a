#include "clients/log/row_notes.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "common/body/angle_deviation.h"
#include "common/stream/device.h"
#include "common/base/number.h"
#include "common/base/utc.h"
#include "common/base/instant.h"
#include "common/base/units.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/device.pb.h"

namespace footing::log_client {
namespace {

namespace pb = google::protobuf;

/// Of /SERVER/CHANNEL.
std::string ServerOf(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos || slash == 0 ? "" : topic.substr(1, slash - 1);
}

std::int64_t NumberOf(const mcap::TextMap& values, const std::string& key) {
  const auto found = values.find(key);
  std::int64_t number = 0;
  if (found != values.end()) {
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), number);
  }
  return number;
}

/// Rows of this type are about a device and do not say its role themselves.
const pb::FieldDescriptor* DeviceField(const pb::Descriptor* row) {
  if (row == nullptr || row->FindFieldByName("role") != nullptr) return nullptr;
  const pb::FieldDescriptor* field = row->FindFieldByName("device");
  const bool number = field != nullptr && !field->is_repeated() &&
                      field->cpp_type() == pb::FieldDescriptor::CPPTYPE_UINT32;
  return number ? field : nullptr;
}

bool IsCharacter(const pb::Descriptor* row) {
  return row != nullptr && row->full_name() == "footing.v1.Character";
}

void AppendNames(const std::vector<std::string>& names, std::size_t count, std::string& out) {
  for (std::size_t i = 0; i < count; ++i) {
    out += ',';
    if (i >= names.size()) continue;
    // A name comes from a motion file: what would break the row is left out.
    for (const char c : names[i]) {
      if (c != ',' && c != '"' && c != '\n' && c != '\r') out += c;
    }
  }
}

/// The stated deviations of the links of a reconstructed person; of others, whose orientations are
/// not estimates, none. A row does not say how far the knees are bent: the larger one counts.
std::vector<double> OrientationDeviations(const v1::Skeleton& skeleton) {
  std::vector<double> deviations;
  if (skeleton.name() != "person") return deviations;
  std::vector<std::string> names;
  std::vector<int> parents;
  for (const v1::Link& link : skeleton.links()) {
    names.push_back(link.name());
    parents.push_back(link.parent());
  }
  for (const body::AngleDeviation& link : body::DeviationsOfLinks(names, parents)) {
    deviations.push_back(DegreesToRadians(std::max(link.upright_deg, link.bent_deg)));
  }
  return deviations;
}

bool IsValid(const pb::Message* character) {
  if (character == nullptr) return false;
  const pb::FieldDescriptor* field = character->GetDescriptor()->FindFieldByName("valid");
  return field != nullptr && !field->is_repeated() &&
         field->cpp_type() == pb::FieldDescriptor::CPPTYPE_BOOL &&
         character->GetReflection()->GetBool(*character, field);
}

void AppendDeviations(const std::vector<double>& deviations, std::size_t count, bool valid,
                      std::string& out) {
  for (std::size_t i = 0; i < count; ++i) {
    out += ',';
    if (valid && i < deviations.size()) text::AppendFixed(out, deviations[i], 3);
  }
}

}  // namespace

void RowNotes::TakeSession(const mcap::TextMap& values) {
  const auto name = values.find("server");
  const std::int64_t wall_ns = NumberOf(values, "server_wall_time_ns");
  const std::int64_t host_ns = NumberOf(values, "server_host_ns");
  if (name == values.end() || wall_ns == 0 || !IsInstant(wall_ns) || !IsInstant(host_ns)) return;
  Server& server = servers_[name->second];
  server.has_wall_time = true;
  server.wall_minus_host_ns = wall_ns - host_ns;
}

void RowNotes::Take(const std::string& topic, std::string_view bytes) {
  const int size = static_cast<int>(bytes.size());
  if (topic.ends_with("/status")) {
    v1::DeviceStatusList list;
    if (!list.ParseFromArray(bytes.data(), size)) return;
    for (const v1::DeviceStatus& status : list.devices()) {
      const auto role = static_cast<stream::DeviceRole>(status.role());
      servers_[ServerOf(topic)].roles[status.device()] =
          status.role() == v1::DEVICE_ROLE_UNSPECIFIED ? "" : stream::Name(role);
    }
  } else if (topic.ends_with("/skeletons")) {
    v1::Skeletons skeletons;
    if (!skeletons.ParseFromArray(bytes.data(), size) || skeletons.skeletons_size() == 0) return;
    Server& server = servers_[ServerOf(topic)];
    const v1::Skeleton& skeleton = skeletons.skeletons(0);
    server.links.clear();
    for (const v1::Link& link : skeleton.links()) server.links.push_back(link.name());
    server.contacts.assign(skeleton.contact_points().begin(), skeleton.contact_points().end());
    server.orientation_sd_rad = OrientationDeviations(skeleton);
    most_deviations_ = std::max(most_deviations_, server.orientation_sd_rad.size());
    most_links_ = std::max(most_links_, server.links.size());
    most_contacts_ = std::max(most_contacts_, server.contacts.size());
  }
}

void RowNotes::TakeTime(std::uint64_t log_time_ns) { first_ns_ = std::min(first_ns_, log_time_ns); }

std::vector<std::string> RowNotes::Columns(const pb::Descriptor* row) const {
  std::vector<std::string> names = {"recording_time_s", "wall_time"};
  if (DeviceField(row) != nullptr) names.push_back("device_role");
  if (!IsCharacter(row)) return names;
  for (std::size_t i = 0; i < most_links_; ++i) {
    names.push_back("links_" + std::to_string(i) + "_name");
  }
  for (std::size_t i = 0; i < most_contacts_; ++i) {
    names.push_back("contacts_" + std::to_string(i) + "_name");
  }
  for (std::size_t i = 0; i < most_deviations_; ++i) {
    names.push_back("links_" + std::to_string(i) + "_orientation_sd_rad");
  }
  return names;
}

const RowNotes::Server& RowNotes::ServerAt(const std::string& topic) const {
  static const Server kUnknown;
  const auto found = servers_.find(ServerOf(topic));
  return found == servers_.end() ? kUnknown : found->second;
}

std::string RowNotes::Role(const std::string& topic, const pb::Descriptor* row,
                           const pb::Message* entry) const {
  const pb::FieldDescriptor* field = DeviceField(row);
  if (field == nullptr || entry == nullptr) return "";
  const Server& server = ServerAt(topic);
  const auto role = server.roles.find(entry->GetReflection()->GetUInt32(*entry, field));
  return role == server.roles.end() ? "" : role->second;
}

std::string RowNotes::DeviationNote(const std::string& topic, const pb::Descriptor* row) const {
  const Server& server = ServerAt(topic);
  if (!IsCharacter(row) || server.orientation_sd_rad.empty()) return "";
  std::string note = "orientation_sd_rad of links 0, 1, ...: ";
  for (std::size_t i = 0; i < server.orientation_sd_rad.size(); ++i) {
    if (i > 0) note += ", ";
    text::AppendFixed(note, server.orientation_sd_rad[i], 3);
  }
  return note + "; " + std::string(body::AngleDeviationSource());
}

std::string RowNotes::Cells(const std::string& topic, const pb::Descriptor* row,
                            const pb::Message* entry, std::uint64_t log_time_ns) const {
  const Server& server = ServerAt(topic);
  char seconds[40];
  std::snprintf(seconds, sizeof seconds, ",%.9f,",
                1e-9 * static_cast<double>(log_time_ns - std::min(first_ns_, log_time_ns)));
  std::string cells = seconds;
  if (server.has_wall_time && IsInstant(log_time_ns)) {
    cells += text::Utc(static_cast<std::int64_t>(log_time_ns) + server.wall_minus_host_ns, 6);
  }
  if (DeviceField(row) != nullptr) cells += ',' + Role(topic, row, entry);
  if (IsCharacter(row)) {
    AppendNames(server.links, most_links_, cells);
    AppendNames(server.contacts, most_contacts_, cells);
    AppendDeviations(server.orientation_sd_rad, most_deviations_, IsValid(entry), cells);
  }
  return cells;
}

}  // namespace footing::log_client
