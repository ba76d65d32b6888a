#include "daemon/offline/bench/lsl_link.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdint>
#include <iostream>
#include <string>
#include <utility>

namespace footing::bench {
namespace {

// liblsl's lsl_c.h: cft_string, nominal_srate of 0 for an irregular rate, seconds.
constexpr int kStringFormat = 3;
constexpr double kIrregularRate = 0;
constexpr double kConnectS = 5;
constexpr double kPullS = 0.2;
constexpr int kBufferedS = 60;

template <typename Function>
bool Load(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(dlsym(library, name));
  return function != nullptr;
}

}  // namespace

/// What is used of liblsl's C interface; its handles are pointers.
struct LslLink::Library {
  void* handle = nullptr;
  void* (*create_info)(const char*, const char*, std::int32_t, double, int, const char*) = nullptr;
  void (*destroy_info)(void*) = nullptr;
  std::int32_t (*resolve)(void**, std::uint32_t, const char*, const char*, std::int32_t,
                          double) = nullptr;
  void* (*create_outlet)(void*, std::int32_t, std::int32_t) = nullptr;
  void (*destroy_outlet)(void*) = nullptr;
  std::int32_t (*push)(void*, const char**, const std::uint32_t*) = nullptr;
  void* (*create_inlet)(void*, std::int32_t, std::int32_t, std::int32_t) = nullptr;
  void (*destroy_inlet)(void*) = nullptr;
  void (*open)(void*, double, std::int32_t*) = nullptr;
  double (*pull)(void*, char**, std::uint32_t*, std::int32_t, double, std::int32_t*) = nullptr;
  void (*destroy_string)(char*) = nullptr;

  bool LoadAll() {
    for (const char* const name : {"liblsl.so.2", "liblsl.so"}) {
      if (handle == nullptr) handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    }
    return handle != nullptr && Load(handle, "lsl_create_streaminfo", create_info) &&
           Load(handle, "lsl_destroy_streaminfo", destroy_info) &&
           Load(handle, "lsl_resolve_byprop", resolve) &&
           Load(handle, "lsl_create_outlet", create_outlet) &&
           Load(handle, "lsl_destroy_outlet", destroy_outlet) &&
           Load(handle, "lsl_push_sample_buf", push) &&
           Load(handle, "lsl_create_inlet", create_inlet) &&
           Load(handle, "lsl_destroy_inlet", destroy_inlet) &&
           Load(handle, "lsl_open_stream", open) && Load(handle, "lsl_pull_sample_buf", pull) &&
           Load(handle, "lsl_destroy_string", destroy_string);
  }
};

std::unique_ptr<LslLink> LslLink::Start(std::function<void(std::string_view)> on_payload) {
  auto library = std::make_unique<Library>();
  if (!library->LoadAll()) {
    std::cerr << "left out: liblsl is not installed" << std::endl;
    return nullptr;
  }
  std::unique_ptr<LslLink> link(new LslLink(std::move(library), std::move(on_payload)));
  if (!link->Connect()) {
    std::cerr << "left out: an inlet of liblsl does not find its outlet" << std::endl;
    return nullptr;
  }
  return link;
}

LslLink::LslLink(std::unique_ptr<Library> library,
                 std::function<void(std::string_view payload)> on_payload)
    : library_(std::move(library)), on_payload_(std::move(on_payload)) {}

LslLink::~LslLink() {
  stop_.Raise();
  if (thread_.joinable()) thread_.join();
  if (inlet_ != nullptr) library_->destroy_inlet(inlet_);
  if (outlet_ != nullptr) library_->destroy_outlet(outlet_);
}

bool LslLink::Connect() {
  const std::string id = "footing-bench-" + std::to_string(getpid());
  void* const info =
      library_->create_info("footing-bench", "ticks", 1, kIrregularRate, kStringFormat, id.c_str());
  if (info == nullptr) return false;
  outlet_ = library_->create_outlet(info, 0, kBufferedS);
  library_->destroy_info(info);
  void* found = nullptr;
  if (outlet_ == nullptr ||
      library_->resolve(&found, 1, "source_id", id.c_str(), 1, kConnectS) < 1) {
    return false;
  }
  inlet_ = library_->create_inlet(found, kBufferedS, 0, 0);
  library_->destroy_info(found);
  if (inlet_ == nullptr) return false;
  std::int32_t error = 0;
  library_->open(inlet_, kConnectS, &error);
  if (error != 0) return false;
  thread_ = std::thread([this] { PullOnThread(); });
  return true;
}

void LslLink::Publish(std::string_view payload) {
  const char* samples[] = {payload.data()};
  const std::uint32_t lengths[] = {static_cast<std::uint32_t>(payload.size())};
  library_->push(outlet_, samples, lengths);
}

void LslLink::PullOnThread() {
  while (!stop_.raised()) {
    char* sample = nullptr;
    std::uint32_t length = 0;
    std::int32_t error = 0;
    library_->pull(inlet_, &sample, &length, 1, kPullS, &error);
    if (sample == nullptr) continue;
    on_payload_(std::string_view(sample, length));
    library_->destroy_string(sample);
  }
}

}  // namespace footing::bench
