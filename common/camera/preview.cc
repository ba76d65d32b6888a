#include "common/camera/preview.h"

#include <algorithm>
#include <bit>

#include "common/camera/preview_reader.h"

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

}  // namespace footing::preview
