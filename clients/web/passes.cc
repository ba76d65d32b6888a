#include "clients/web/passes.h"

#include <algorithm>
#include <sstream>
#include <tuple>

#include <boost/asio/ip/address.hpp>

#include "common/base/units.h"
#include "common/model/model.h"
#include "common/net/access.h"

namespace footing::web {
namespace {

std::string HashOf(std::string_view pass) { return model::Hex(model::Sha256(pass)); }

bool IsHash(const std::string& text) {
  return text.size() == 2 * std::tuple_size_v<model::Digest> &&
         text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

std::string Passes::NewCode(Right right, std::int64_t now_ns) {
  codes_.push_back({random_(), right, now_ns + SecondsToNanoseconds(kCodeLastsS)});
  if (codes_.size() > kMostCodes) codes_.pop_front();
  return codes_.back().secret;
}

std::optional<std::string> Passes::Redeem(std::string_view code, std::int64_t now_ns) {
  // Every code is compared, so that the time says nothing.
  auto found = codes_.end();
  for (auto one = codes_.begin(); one != codes_.end(); ++one) {
    if (transport::IsSameSecret(one->secret, code) && now_ns < one->until_ns) found = one;
  }
  if (found == codes_.end()) return std::nullopt;
  std::string pass = random_();
  passes_.push_back({HashOf(pass), found->right, now_ns + SecondsToNanoseconds(kPassLastsS)});
  codes_.erase(found);
  if (passes_.size() > kMostPasses) passes_.pop_front();
  return pass;
}

Right Passes::RightOf(std::string_view pass, std::int64_t now_ns) const {
  const std::string hash = HashOf(pass);
  Right right = Right::kNone;
  for (const Entry& one : passes_) {
    if (transport::IsSameSecret(one.secret, hash) && now_ns < one.until_ns) right = one.right;
  }
  return right;
}

std::string Passes::Text(std::int64_t now_ns, std::int64_t wall_ns) const {
  std::string text;
  for (const Entry& one : passes_) {
    if (now_ns >= one.until_ns) continue;
    const std::int64_t until_s = (wall_ns + one.until_ns - now_ns) / kNanosecondsPerSecond;
    text += one.secret + " " + std::to_string(static_cast<int>(one.right)) + " " +
            std::to_string(until_s) + "\n";
  }
  return text;
}

void Passes::Take(std::string_view text, std::int64_t now_ns, std::int64_t wall_ns) {
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string hash;
    int right = 0;
    std::int64_t until_s = 0;
    if (!(words >> hash >> right >> until_s) || !IsHash(hash)) continue;
    if (right < static_cast<int>(Right::kView) || right > static_cast<int>(Right::kDevices))
      continue;
    // The wall clock may have been set meanwhile: no pass lasts longer than a new one.
    const double left_s = static_cast<double>(until_s) - NanosecondsToSeconds(wall_ns);
    if (!(left_s > 0) || passes_.size() >= kMostPasses) continue;
    passes_.push_back({hash, static_cast<Right>(right),
                       now_ns + SecondsToNanoseconds(std::min(left_s, kPassLastsS))});
  }
}

std::string_view CookieIn(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(';'), header.size());
    std::string_view one = header.substr(0, end);
    while (one.starts_with(' ')) one.remove_prefix(1);
    if (one.starts_with(name) && one.substr(name.size()).starts_with('=')) {
      return one.substr(name.size() + 1);
    }
    header.remove_prefix(std::min(end + 1, header.size()));
  }
  return {};
}

bool IsOwnHost(std::string_view host, const std::vector<std::string>& names) {
  std::string_view name = host;
  if (name.starts_with('[')) {
    name = name.substr(1, name.find(']') == std::string_view::npos ? 0 : name.find(']') - 1);
  } else {
    name = name.substr(0, name.find(':'));
  }
  if (name == "localhost") return true;
  if (std::find(names.begin(), names.end(), name) != names.end()) return true;
  boost::system::error_code error;
  boost::asio::ip::make_address(std::string(name), error);
  return !error;
}

}  // namespace footing::web
