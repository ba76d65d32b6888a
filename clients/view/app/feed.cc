#include "clients/view/app/feed.h"

#include <chrono>
#include <utility>

#include <boost/asio/post.hpp>

#include "clients/view/app/recorded_show.h"
#include "common/runtime/clock.h"

namespace footing::view {
namespace {

scene::LinkState StateOf(transport::LinkState state) {
  switch (state) {
    case transport::LinkState::kConnecting:
      return scene::LinkState::kConnecting;
    case transport::LinkState::kLive:
      return scene::LinkState::kLive;
    case transport::LinkState::kStale:
      return scene::LinkState::kStale;
    case transport::LinkState::kRefused:
      return scene::LinkState::kRefused;
  }
  return scene::LinkState::kConnecting;
}

}  // namespace

std::vector<scene::LinkReport> Feed::InitialReports(const Options& options) {
  std::vector<scene::LinkReport> reports;
  for (const transport::Address& address : options.addresses) {
    reports.push_back({address.Text(), "", scene::LinkState::kConnecting, ""});
  }
  return reports;
}

Feed::Feed(boost::asio::io_context& io, const Options& options, Handlers handlers)
    : handlers_(std::move(handlers)) {
  const auto reports = InitialReports(options);
  for (std::size_t i = 0; i < options.addresses.size(); ++i) {
    const transport::Address& address = options.addresses[i];
    const bool same_host = address.kind == transport::Address::Kind::kUnix;
    sources_.push_back({reports[i], same_host, Connect(io, static_cast<int>(i), address)});
  }
}

std::unique_ptr<transport::Client> Feed::Connect(boost::asio::io_context& io, int source,
                                                 const transport::Address& address) {
  const auto index = static_cast<std::size_t>(source);
  transport::ClientOptions options;
  options.address = address;
  options.client_name = "footing-view";
  // On the machine itself the keys T and N may command; elsewhere the viewer only looks.
  const bool local = address.kind == transport::Address::Kind::kUnix;
  options.role = local ? v1::ROLE_CONTROL : v1::ROLE_VIEW;
  options.channels = {"status",    "motion", "features",   "boards", "hands",
                      "skeletons", "track",  "characters", "events", "setup",
                      "reference", "game",   "study"};
  transport::ClientHandlers handlers;
  handlers.on_welcome = [this, source, index](const v1::Welcome& welcome) {
    sources_[index].report.server_id = welcome.server_id();
    handlers_.on_link(source, sources_[index].report);
  };
  handlers.on_tick = [this, source, index](const v1::Tick& tick) {
    handlers_.on_update(Translate(tick, source, clock::MonotonicNs(), OffsetOf(sources_[index])));
  };
  handlers.on_gap = [](const v1::Gap&) {};  // The picture goes on with what there is.
  handlers.on_state = [this, source, index](transport::LinkState state, const std::string& why) {
    sources_[index].report.state = StateOf(state);
    sources_[index].report.why = why;
    handlers_.on_link(source, sources_[index].report);
  };
  handlers.on_notice = [this, source](const v1::Notice& notice) {
    handlers_.on_update(TranslateNotice(notice, source, clock::MonotonicNs()));
  };
  return std::make_unique<transport::Client>(io, options, std::move(handlers));
}

// On one host both read the same clock: an estimate could only add its own error.
std::int64_t Feed::OffsetOf(const Source& source) const {
  if (source.same_host) return 0;
  const transport::ClockOffset offset = source.client->clock();
  return offset.valid ? offset.offset_ns : 0;
}

void Feed::SendTo(const std::string& server_id, const v1::Command& command) {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    Source& source = sources_[i];
    if (source.report.server_id != server_id || !source.client) continue;
    source.client->Send(command, [this, i](const v1::CommandResult& result) {
      if (result.ok()) return;
      scene::Update refusal;
      refusal.source = static_cast<int>(i);
      refusal.live = false;
      refusal.received_ns = clock::MonotonicNs();
      refusal.notes.push_back({scene::NoteKind::kOther, refusal.received_ns, result.message(), {}});
      handlers_.on_update(std::move(refusal));
    });
  }
}

void Feed::Start() {
  for (Source& source : sources_) source.client->Start();
}

void Feed::Stop() {
  for (Source& source : sources_) source.client->Stop();
}

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
  again_.After(kDialEvery, [this] { Dial(); });
}

namespace {

// Four seconds of ticks: a picture that takes longer loses some, which nobody sees.
constexpr std::size_t kQueuedTicks = 1024;
constexpr char kSensors[] = "footingd";

}  // namespace

Background::Background(const Options& options)
    : end_(io_, [this] { stop_.Raise(); }),
      updates_(kQueuedTicks),
      feed_(io_, options,
            {[this](scene::Update update) { updates_.Push(std::move(update)); },
             [this](int source, const scene::LinkReport& report) {
               links_[static_cast<std::size_t>(source)]->Write(report);
             }}),
      preview_link_(io_, options.camera.address,
                    [this](const scene::CameraPreview& preview) { preview_.Write(preview); }) {
  for (const scene::LinkReport& report : Feed::InitialReports(options)) {
    links_.push_back(std::make_unique<exchange::Latest<scene::LinkReport>>(report));
  }
  thread_ = std::thread([this] { RunOnIoThread(); });
  WantPreview(options.camera.corner || options.camera.alone);
}

void Background::RunOnIoThread() {
  feed_.Start();
  io_.run();
}

Background::~Background() {
  boost::asio::post(io_, [this] {
    feed_.Stop();
    preview_link_.Stop();
    end_.cancel();
    io_.stop();
  });
  thread_.join();
}

void Background::SendTo(const std::string& server_id, v1::Command command) {
  boost::asio::post(
      io_, [this, server_id, command = std::move(command)] { feed_.SendTo(server_id, command); });
}

void Background::WantPreview(bool wanted) {
  if (std::exchange(preview_wanted_, wanted) == wanted) return;
  boost::asio::post(io_, [this, wanted] {
    if (wanted) {
      preview_link_.Start();
    } else {
      preview_link_.Stop();
    }
  });
}

void Background::Drain(scene::Show& show, PoseCalibration* calibration) {
  std::vector<scene::LinkReport>& reports = show.model().links;
  reports.resize(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    links_[i]->Refresh();
    reports[i] = links_[i]->Front();
  }
  preview_.Refresh();
  show.model().observed.camera = preview_.Front();
  scene::Update update;
  while (updates_.Pop(update)) {
    const bool of_sensors = reports[static_cast<std::size_t>(update.source)].server_id == kSensors;
    if (calibration != nullptr && of_sensors) calibration->Take(update);
    show.Take(update, clock::MonotonicNs());
  }
  if (calibration != nullptr) {
    calibration->Advance(show.model(),
                         [this](v1::Command command) { SendTo(kSensors, std::move(command)); });
  }
}

}  // namespace footing::view
