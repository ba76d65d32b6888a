#include "clients/view/app/preview_link.h"

#include <chrono>
#include <utility>

namespace footing::view {
namespace {

using State = scene::CameraPreview::State;

constexpr std::chrono::seconds kDialEvery(1);

}  // namespace

PreviewLink::PreviewLink(boost::asio::io_context& io, transport::Address address,
                         OnChange on_change)
    : io_(io), address_(std::move(address)), on_change_(std::move(on_change)), again_(io) {
  shown_.address = address_.Text();
}

void PreviewLink::Start() {
  if (run_) return;
  run_ = std::make_shared<const int>(0);
  Dial();
}

void PreviewLink::Stop() {
  if (!run_) return;
  run_.reset();
  again_.cancel();
  if (socket_) socket_->Close();
  socket_.reset();
  shown_.picture.reset();
  Show(State::kNone, "");
}

void PreviewLink::Show(State state, const std::string& why) {
  shown_.state = state;
  shown_.why = why;
  on_change_(shown_);
}

void PreviewLink::Dial() {
  transport::Dial(io_, address_, [this, run = run_](Result<transport::Socket> dialled) {
    if (run != run_) return;
    if (!dialled) return Lose(State::kAbsent, dialled.error().message);
    reader_ = preview::PreviewReader();
    socket_.emplace(std::move(dialled).value());
    Show(State::kWaiting, "");
    Read();
  });
}

void PreviewLink::Read() {
  socket_->plain().async_read_some(
      boost::asio::buffer(bytes_),
      [this, run = run_](const boost::system::error_code& error, std::size_t count) {
        if (run != run_) return;
        if (!error) return TakeBytes(count);
        const bool refused = shown_.state == State::kRefused;
        Lose(refused ? State::kRefused : State::kAbsent,
             refused ? shown_.why : address_.Text() + ": it has ended");
      });
}

void PreviewLink::TakeBytes(std::size_t count) {
  reader_.Add({bytes_.data(), count});
  for (;;) {
    auto next = reader_.Next();
    if (!next) return Lose(State::kRefused, next.error().message);
    if (!*next) return Read();
    if (auto* const picture = std::get_if<preview::Picture>(&**next)) {
      shown_.picture = std::make_shared<const preview::Picture>(std::move(*picture));
      Show(State::kShown, "");
    } else {
      Show(State::kRefused, std::get<preview::Refusal>(**next).why);
    }
  }
}

/// The last picture stays, with its age, until there is a newer one.
void PreviewLink::Lose(State state, const std::string& why) {
  if (socket_) socket_->Close();
  socket_.reset();
  Show(state, why);
  again_.expires_after(kDialEvery);
  again_.async_wait([this, run = run_](const boost::system::error_code& error) {
    if (!error && run == run_) Dial();
  });
}

}  // namespace footing::view
