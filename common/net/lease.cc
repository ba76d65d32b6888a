#include "common/net/lease.h"

#include <utility>

#include "common/base/utf8.h"
#include "common/base/units.h"

namespace footing::lease {
namespace {

bool IsName(const std::string& holder) {
  return !holder.empty() && holder.size() <= Lease::kMaxHolder && text::IsPrintable(holder);
}

}  // namespace

Error Lease::HeldByError() const {
  const std::string of = server_ == "footing-sim" ? "" : " --of " + server_;
  return Failure(holder_ + " has the lease of this " + server_ +
                 "; wait until that ends, or take it over: footing-ctl lease" + of +
                 " --take-over");
}

bool Lease::HeldBy(std::uint64_t session, std::int64_t now_ns) const {
  return !holder_.empty() && now_ns < end_ns_ && session == session_ && !session_ended_;
}

bool Lease::HeldByOther(std::uint64_t session, std::int64_t now_ns) const {
  return !holder_.empty() && now_ns < end_ns_ && (session != session_ || session_ended_);
}

Result<void> Lease::Take(const Request& request, std::int64_t now_ns) {
  if (!IsName(request.holder)) {
    return UsageError("the holder must be 1 to 200 bytes without control characters");
  }
  if (!(request.seconds >= 0 && request.seconds <= kLongestS)) {
    return UsageError("seconds must be from 0 to 60");
  }
  Expire(now_ns);
  const bool mine = HeldBy(request.session, now_ns);
  // Nobody took it since its last holder, who was only late.
  const bool late = holder_.empty() && request.session == session_ && !session_ended_;
  if (request.renew_only && !mine && !late) {
    if (!holder_.empty()) return HeldByError();
    return Failure("this session does not have the lease any more: it ran out, or was taken over");
  }
  const bool goes_on = session_ended_ && request.holder == holder_;
  if (HeldByOther(request.session, now_ns) && !goes_on && !request.take_over) {
    return HeldByError();
  }
  if (holder_.empty()) {
    changes_.push_back("lease: " + request.holder + " takes it");
  } else if (!mine && !goes_on) {
    changes_.push_back("lease: " + request.holder + " takes it over from " + holder_);
  }
  holder_ = request.holder;
  session_ = request.session;
  session_ended_ = false;
  end_ns_ = now_ns + SecondsToNanoseconds(request.seconds > 0 ? request.seconds : kUsualS);
  return {};
}

Result<void> Lease::Release(std::uint64_t session, std::int64_t now_ns) {
  Expire(now_ns);
  if (HeldByOther(session, now_ns)) return HeldByError();
  if (holder_.empty()) return Failure("nobody has the lease of this " + server_);
  End("lease: " + holder_ + " releases it");
  session_ = 0;
  return {};
}

Result<void> Lease::Check(std::uint64_t session, std::int64_t now_ns) const {
  if (HeldByOther(session, now_ns)) return HeldByError();
  return {};
}

void Lease::EndSession(std::uint64_t session) {
  session_ended_ = session_ended_ || session == session_;
}

void Lease::Expire(std::int64_t now_ns) {
  if (!holder_.empty() && now_ns >= end_ns_) End("lease: that of " + holder_ + " ran out");
}

void Lease::End(const std::string& change) {
  changes_.push_back(change);
  holder_.clear();
}

std::vector<std::string> Lease::TakeChanges() { return std::exchange(changes_, {}); }

}  // namespace footing::lease
