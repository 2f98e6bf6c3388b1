// SPDX-License-Identifier: Apache-2.0
#include "service/panel/panel.hpp"

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "service/panel/hub.hpp"
#include "service/panel/machine_watch.hpp"
#include "service/panel/operator_desk.hpp"
#include "service/panel/operator_pages.hpp"
#include "service/panel/server.hpp"

namespace meridian::panel {
namespace {

[[nodiscard]] OperatorPages::Desk desk_of(OperatorDesk& desk, const MachineWatch& watch) {
  return {[&desk](Verb verb, double argument, const stream::Seen& seen, OnOutcome on_outcome) {
            desk.ask(verb, argument, seen, std::move(on_outcome));
          },
          [&desk](const stream::JogPlan& plan, std::shared_ptr<JogGrip> grip,
                  OnOutcome on_outcome) { desk.jog(plan, std::move(grip), std::move(on_outcome)); },
          [&watch] { return watch.newest_status(); }};
}

/// A panel that only watches says so to its pages and passes nothing on.
[[nodiscard]] PageHandler watching() {
  PageHandler handler;
  handler.on_open = [](PageLink& page) { page.say(R"({"t":"operator","who":"watching"})"); };
  return handler;
}

[[nodiscard]] PageHandler operating(OperatorPages& pages) {
  PageHandler handler;
  handler.on_open = [&pages](PageLink& page) { pages.open(page); };
  handler.on_text = [&pages](PageLink& page, std::string_view text) { pages.read(page, text); };
  handler.on_close = [&pages](PageLink& page) { pages.close(page); };
  return handler;
}

}  // namespace

void run_panel(dds::Participant& participant, const PanelOptions& options,
               const std::atomic<bool>& is_ending,
               const std::function<void(std::uint16_t)>& on_ready) {
  constexpr std::chrono::milliseconds kBetweenPolls{20};
  Hub hub;
  MachineWatch watch(participant, hub);
  // Outcomes go to pages, so the desk ends first; pages talk to the desk, so the server goes
  // before.
  std::optional<OperatorDesk> desk;
  std::optional<OperatorPages> pages;
  if (!options.is_watching) {
    desk.emplace(participant, options.operator_name);
    pages.emplace(desk_of(*desk, watch));
  }
  {
    PageHandler handler = pages ? operating(*pages) : watching();
    handler.metrics = [&hub] {
      const Hub::Text text = hub.newest(Hub::kMetrics);
      return text ? *text : std::string();
    };
    const Server server(hub, options.port, std::move(handler));
    on_ready(server.port());
    while (!is_ending) {
      watch.poll();
      std::this_thread::sleep_for(kBetweenPolls);
    }
  }
  desk.reset();
}

}  // namespace meridian::panel
