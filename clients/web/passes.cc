#include "clients/web/passes.h"

#include <algorithm>

#include <boost/asio/ip/address.hpp>

#include "common/base/units.h"
#include "common/net/access.h"

namespace footing::web {

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
  passes_.push_back({random_(), found->right, now_ns + SecondsToNanoseconds(kPassLastsS)});
  codes_.erase(found);
  if (passes_.size() > kMostPasses) passes_.pop_front();
  return passes_.back().secret;
}

Right Passes::RightOf(std::string_view pass, std::int64_t now_ns) const {
  Right right = Right::kNone;
  for (const Entry& one : passes_) {
    if (transport::IsSameSecret(one.secret, pass) && now_ns < one.until_ns) right = one.right;
  }
  return right;
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
