#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <optional>

#include "clients/view/scene/camera_preview.h"
#include "common/camera/preview_reader.h"
#include "common/net/address.h"
#include "common/net/socket.h"

namespace footing::view {

/// Receives the preview of footing-camera while it is wanted; dials again every second. Everything
/// runs on the io_context's one thread.
class PreviewLink {
 public:
  using OnChange = std::function<void(const scene::CameraPreview&)>;

  PreviewLink(boost::asio::io_context& io, transport::Address address, OnChange on_change);
  void Start();
  void Stop();

 private:
  void Dial();
  void Read();
  void TakeBytes(std::size_t count);
  void Lose(scene::CameraPreview::State state, const std::string& why);
  void Show(scene::CameraPreview::State state, const std::string& why);

  static constexpr std::size_t kPiece = std::size_t{1} << 16;

  boost::asio::io_context& io_;
  transport::Address address_;
  OnChange on_change_;
  boost::asio::steady_timer again_;
  std::array<char, kPiece> bytes_{};
  std::optional<transport::Socket> socket_;
  preview::PreviewReader reader_;
  scene::CameraPreview shown_;
  std::shared_ptr<const int> run_;  ///< Of this run: what an earlier one began has another.
};

}  // namespace footing::view
