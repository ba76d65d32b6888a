#include "common/camera/preview.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace footing::preview {
namespace {

template <typename T>
void Put(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i)));
}

void Put(std::string& out, float value) { Put(out, std::bit_cast<std::uint32_t>(value)); }

void Put(std::string& out, const Circle& circle) {
  Put(out, circle.u_px);
  Put(out, circle.v_px);
  Put(out, circle.radius_px);
}

std::string Header(Kind kind, std::size_t bytes) {
  std::string out(kMagic);
  Put(out, static_cast<std::uint32_t>(kind));
  Put(out, static_cast<std::uint32_t>(bytes));
  return out;
}

}  // namespace

std::string Encode(const Picture& picture) {
  const std::size_t spheres = std::min(picture.spheres.size(), kMaxSpheres);
  const std::size_t refused = std::min(picture.refused.size(), kMaxRefused);
  std::string body;
  body.reserve(kFixedBytes + kSphereBytes * spheres + kRefusedBytes * refused + picture.rgb.size());
  Put(body, picture.number);
  Put(body, picture.exposed_ns);
  for (const int length :
       {picture.camera_width, picture.camera_height, picture.width, picture.height})
    Put(body, static_cast<std::uint16_t>(length));
  Put(body, static_cast<std::uint16_t>((picture.has_pose ? kHasPose : 0) |
                                       (picture.simulated ? kSimulated : 0)));
  Put(body, static_cast<std::uint8_t>(spheres));
  Put(body, static_cast<std::uint8_t>(refused));
  for (std::size_t i = 0; i < spheres; ++i) {
    const Sphere& sphere = picture.spheres[i];
    Put(body, static_cast<std::uint8_t>(sphere.role));
    Put(body, static_cast<std::uint8_t>(sphere.sight));
    Put(body, static_cast<std::uint16_t>((sphere.is_saturated ? kSaturated : 0) |
                                         (sphere.is_occluded ? kOccluded : 0)));
    Put(body, sphere.confidence);
    Put(body, sphere.range_m);
    Put(body, sphere.circle);
  }
  for (std::size_t i = 0; i < refused; ++i) {
    Put(body, static_cast<std::uint32_t>(picture.refused[i].role));
    Put(body, picture.refused[i].circle);
  }
  body.append(picture.rgb.begin(), picture.rgb.end());
  return Header(Kind::kPicture, body.size()) + body;
}

std::string EncodeRefusal(const std::string& why) {
  const std::string text = why.substr(0, kMaxText);
  return Header(Kind::kRefusal, text.size()) + text;
}

namespace {

constexpr float kMostPx = 1e5f, kFarthestM = 1e3f;

Error Malformed(const std::string& what) {
  return InvalidData("not a camera preview: " + what +
                     "; footing-camera and footing-view must be of one version");
}

/// Takes numbers from bytes whose count was checked before.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  T Take() {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      value |= std::uint64_t{static_cast<std::uint8_t>(bytes_[i])} << (8 * i);
    bytes_.remove_prefix(sizeof(T));
    return static_cast<T>(value);
  }
  /// Within 0 and `most`; what is not becomes 0.
  float TakeLength(float most) {
    const auto value = std::bit_cast<float>(Take<std::uint32_t>());
    return std::isfinite(value) && value >= 0 && value <= most ? value : 0;
  }
  Circle TakeCircle() {
    Circle circle;
    circle.u_px = TakeLength(kMostPx);
    circle.v_px = TakeLength(kMostPx);
    circle.radius_px = TakeLength(kMostPx);
    return circle;
  }
  std::string_view rest() const { return bytes_; }

 private:
  std::string_view bytes_;
};

stream::DeviceRole RoleOf(std::uint32_t number) {
  const bool is_known = number <= static_cast<std::uint32_t>(stream::kDeviceRoles.back());
  return is_known ? static_cast<stream::DeviceRole>(number) : stream::DeviceRole::kUnspecified;
}

Sphere TakeSphere(Cursor& from) {
  Sphere sphere;
  sphere.role = RoleOf(from.Take<std::uint8_t>());
  const auto sight = from.Take<std::uint8_t>();
  sphere.sight = sight <= static_cast<std::uint8_t>(Sight::kSeen) ? static_cast<Sight>(sight)
                                                                  : Sight::kNothing;
  const unsigned flags = from.Take<std::uint16_t>();
  sphere.is_saturated = (flags & kSaturated) != 0;
  sphere.is_occluded = (flags & kOccluded) != 0;
  sphere.confidence = from.TakeLength(1);
  sphere.range_m = from.TakeLength(kFarthestM);
  sphere.circle = from.TakeCircle();
  return sphere;
}

Result<Picture> TakePicture(std::string_view body) {
  if (body.size() < kFixedBytes)
    return Malformed("a picture of " + std::to_string(body.size()) + " bytes");
  Cursor from(body);
  Picture picture;
  picture.number = from.Take<std::uint64_t>();
  picture.exposed_ns = from.Take<std::int64_t>();
  picture.camera_width = from.Take<std::uint16_t>();
  picture.camera_height = from.Take<std::uint16_t>();
  picture.width = from.Take<std::uint16_t>();
  picture.height = from.Take<std::uint16_t>();
  const unsigned flags = from.Take<std::uint16_t>();
  picture.has_pose = (flags & kHasPose) != 0;
  picture.simulated = (flags & kSimulated) != 0;
  const std::size_t spheres = from.Take<std::uint8_t>(), refused = from.Take<std::uint8_t>();
  const auto sides = std::minmax({picture.width, picture.height});
  if (sides.first < 1 || sides.second > kMaxSide || picture.camera_width < picture.width ||
      picture.camera_height < picture.height)
    return Malformed("its size is " + std::to_string(picture.width) + " x " +
                     std::to_string(picture.height));
  const std::size_t rgb_bytes = std::size_t{3} * static_cast<std::size_t>(picture.width) *
                                static_cast<std::size_t>(picture.height);
  if (spheres > kMaxSpheres || refused > kMaxRefused ||
      from.rest().size() != kSphereBytes * spheres + kRefusedBytes * refused + rgb_bytes)
    return Malformed("its length does not fit its size");
  for (std::size_t i = 0; i < spheres; ++i) picture.spheres.push_back(TakeSphere(from));
  for (std::size_t i = 0; i < refused; ++i) {
    const stream::DeviceRole role = RoleOf(from.Take<std::uint32_t>());
    picture.refused.push_back({role, from.TakeCircle()});
  }
  picture.rgb.assign(from.rest().begin(), from.rest().end());
  return picture;
}

/// Only what a screen can show.
Refusal TakeRefusal(std::string_view body) {
  Refusal refusal{std::string(body.substr(0, kMaxText))};
  std::replace_if(
      refusal.why.begin(), refusal.why.end(),
      [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return refusal;
}

}  // namespace

Result<std::optional<Message>> PreviewReader::Next() {
  const std::size_t begun = std::min(pending_.size(), kMagic.size());
  if (std::string_view(pending_).substr(0, begun) != kMagic.substr(0, begun))
    return Malformed("it does not begin with FCP1");
  if (pending_.size() < kHeaderBytes) return std::optional<Message>();
  Cursor header(std::string_view(pending_).substr(kMagic.size()));
  const auto kind = header.Take<std::uint32_t>();
  const auto bytes = header.Take<std::uint32_t>();
  const bool is_picture = kind == static_cast<std::uint32_t>(Kind::kPicture);
  if (!is_picture && kind != static_cast<std::uint32_t>(Kind::kRefusal))
    return Malformed("message kind " + std::to_string(kind));
  if (bytes > (is_picture ? kMaxBodyBytes : kMaxText))
    return Malformed("a message of " + std::to_string(bytes) + " bytes");
  if (pending_.size() < kHeaderBytes + bytes) return std::optional<Message>();
  const auto body = std::string_view(pending_).substr(kHeaderBytes, bytes);
  std::optional<Message> message;
  if (is_picture) {
    auto picture = TakePicture(body);
    if (!picture) return picture.error();
    message = std::move(picture).value();
  } else {
    message = TakeRefusal(body);
  }
  pending_.erase(0, kHeaderBytes + bytes);
  return message;
}

}  // namespace footing::preview
