// SPDX-License-Identifier: Apache-2.0
#include "service/panel/panel.hpp"

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "service/panel/desks/action_desk.hpp"
#include "service/panel/desks/operator_desk.hpp"
#include "service/panel/desks/program_desk.hpp"
#include "service/panel/serve/hub.hpp"
#include "service/panel/serve/operator_pages.hpp"
#include "service/panel/serve/server.hpp"
#include "service/panel/status/costly_parts.hpp"
#include "service/panel/status/machine_watch.hpp"

namespace meridian::panel {
namespace {

/// Who serves what moves nothing; no actions: somebody else answers them.
struct Desks {
  ProgramDesk& programs;
  ActionDesk* actions;
};

[[nodiscard]] Outcome serve(Desks desks, const PageMessage& message) {
  ProgramDesk& programs = desks.programs;
  switch (message.kind) {
    case PageMessage::Kind::kAnswer:
      if (desks.actions == nullptr) return {false, "this panel does not answer actions"};
      return desks.actions->answer(message.action, message.is_done);
    case PageMessage::Kind::kCheck:
      return programs.check(message.line);
    case PageMessage::Kind::kLoad:
      return programs.load();
    default:
      return programs.unload();
  }
}

[[nodiscard]] OperatorPages::Desk desk_of(OperatorDesk& desk, const MachineWatch& watch,
                                          Desks desks) {
  return {[&desk](Verb verb, double argument, const stream::Seen& seen, OnOutcome on_outcome) {
            desk.ask(verb, argument, seen, std::move(on_outcome));
          },
          [&desk](const stream::JogPlan& plan, std::shared_ptr<JogGrip> grip,
                  OnOutcome on_outcome) { desk.jog(plan, std::move(grip), std::move(on_outcome)); },
          [&watch] { return watch.newest_status(); },
          [desks](const PageMessage& message) { return serve(desks, message); }};
}

/// What pages send and get beside their link.
[[nodiscard]] HttpAnswer receive(OperatorPages& pages, ProgramDesk& programs,
                                 const HttpUpload& upload) {
  constexpr int kForbidden = 403, kConflict = 409;
  if (!pages.may_operate(upload.key)) {
    return {.status = kForbidden, .text = OperatorPages::kOtherOperates};
  }
  const Outcome outcome = programs.receive(upload.name, upload.bytes, upload.read);
  return {.status = outcome.is_accepted ? 200 : kConflict, .text = outcome.text};
}

/// What pages ask for; programs: null where the panel only watches.
struct Sources {
  CostlyParts& costly;
  const MachineWatch& watch;
  const ProgramDesk* programs = nullptr;
};

[[nodiscard]] std::optional<HttpAnswer> find_part(const Sources& sources, const HttpQuery& query) {
  constexpr const char* kBytes = "application/octet-stream";
  if (query.path == "/doctor") return sources.costly.host_findings(CostlyParts::Clock::now());
  if (query.path == "/mesh") {
    return sources.costly.one_at_a_time([&]() -> std::optional<HttpAnswer> {
      auto mesh = sources.watch.mesh(query.number("number"));
      if (!mesh) return std::nullopt;
      return HttpAnswer{.type = kBytes, .text = std::move(*mesh)};
    });
  }
  const ProgramDesk* const programs = sources.programs;
  if (programs == nullptr) return std::nullopt;
  if (query.path == "/program/lines") {
    return HttpAnswer{.text = programs->read_lines(query.number("first"), query.number("count"))};
  }
  if (query.path != "/program/path") return std::nullopt;
  const Hub::Text path = programs->path();
  if (!path) return std::nullopt;
  return HttpAnswer{.type = kBytes, .text = *path};
}

/// A panel that only watches says so to its pages and passes nothing on.
[[nodiscard]] PageHandler watching(const Sources& sources) {
  PageHandler handler;
  handler.get = [sources](const HttpQuery& query) { return find_part(sources, query); };
  handler.on_open = [](PageLink& page) { page.say(R"({"t":"operator","who":"watching"})"); };
  return handler;
}

[[nodiscard]] PageHandler operating(const Sources& sources, OperatorPages& pages,
                                    ProgramDesk& programs) {
  PageHandler handler;
  handler.upload = [&](const HttpUpload& upload) { return receive(pages, programs, upload); };
  handler.get = [sources](const HttpQuery& query) { return find_part(sources, query); };
  handler.on_open = [&pages](PageLink& page) { pages.open(page); };
  handler.on_text = [&pages](PageLink& page, std::string_view text) { pages.read(page, text); };
  handler.on_close = [&pages](PageLink& page) { pages.close(page); };
  return handler;
}

/// Why there is none: an identity that may not command makes a panel that watches. Throws DdsError
/// where it is not the identity that is refused.
[[nodiscard]] std::string open_desk(dds::Participant& participant, const std::string& name,
                                    std::optional<OperatorDesk>& desk) {
  try {
    desk.emplace(participant, name);
    return "";
  } catch (const dds::DdsError& error) {
    if (!participant.is_secured()) throw;
    return error.what();
  }
}

}  // namespace

void run_panel(dds::Participant& participant, const PanelOptions& options,
               const std::atomic<bool>& is_ending,
               const std::function<void(const PanelOpened&)>& on_ready) {
  constexpr std::chrono::milliseconds kBetweenPolls{20};
  Hub hub;
  CostlyParts costly(options.examine_host);
  MachineWatch watch(participant, hub, {options.history_file, options.mesh_folder});
  // Outcomes go to pages, so the desk ends first; pages talk to the desk, so the server goes
  // before.
  std::optional<OperatorDesk> desk;
  std::optional<ProgramDesk> programs;
  std::optional<ActionDesk> actions;
  std::optional<OperatorPages> pages;
  std::string refusal;
  if (!options.is_watching) refusal = open_desk(participant, options.operator_name, desk);
  if (desk) {
    programs.emplace(
        participant, hub, [&watch] { return watch.machine(); }, options.station_name);
    if (options.answers_actions) actions.emplace(participant, hub);
    pages.emplace(desk_of(*desk, watch, {*programs, actions ? &*actions : nullptr}));
  }
  {
    const Sources sources{costly, watch, programs ? &*programs : nullptr};
    PageHandler handler = pages ? operating(sources, *pages, *programs) : watching(sources);
    handler.metrics = [&hub] {
      const Hub::Text text = hub.newest(Hub::kMetrics);
      return text ? *text : std::string();
    };
    const Server server(hub, {options.port, options.public_host, options.token},
                        std::move(handler));
    on_ready({server.port(), refusal});
    while (!is_ending) {
      watch.poll();
      if (actions) actions->poll(watch.status());
      std::this_thread::sleep_for(kBetweenPolls);
    }
  }
  programs.reset();
  desk.reset();
}

}  // namespace meridian::panel
