#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <thread>

#include "common/runtime/flag.h"

namespace footing::bench {

/// Another publisher to compare with: an outlet and an inlet of liblsl in this process, with one
/// string a sample. The library is opened while this program runs, since Debian does not have it.
class LslLink {
 public:
  /// Null, with a line on standard error, if liblsl is not installed or its inlet does not find the
  /// outlet. `on_payload` runs on a thread of the inlet.
  static std::unique_ptr<LslLink> Start(std::function<void(std::string_view payload)> on_payload);
  ~LslLink();
  LslLink(const LslLink&) = delete;
  LslLink& operator=(const LslLink&) = delete;

  /// On any one thread.
  void Publish(std::string_view payload);

 private:
  struct Library;

  LslLink(std::unique_ptr<Library> library,
          std::function<void(std::string_view payload)> on_payload);
  bool Connect();
  void PullOnThread();

  std::unique_ptr<Library> library_;
  std::function<void(std::string_view payload)> on_payload_;
  void* outlet_ = nullptr;
  void* inlet_ = nullptr;
  exchange::Flag stop_;
  std::thread thread_;
};

}  // namespace footing::bench
