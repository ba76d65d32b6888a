#include "clients/view/app/feed.h"

#include "clients/view/app/translate.h"
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

}  // namespace footing::view
