// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "service/transport/participant.hpp"

namespace meridian::panel {

struct PanelOptions {
  std::uint16_t port = 8090;     ///< of loopback; 0: any that is free
  std::string public_host;       ///< of a TLS proxy in front of it; empty: there is none
  std::string token;             ///< what browsers and programs have to show; empty: nothing
  std::string operator_name;     ///< for messages and the log
  std::string history_file;      ///< audit log of the service; empty: none is read
  std::string mesh_folder;       ///< of the meshes that the machine file names; empty: none are drawn
  std::string station_name;      ///< of the panel as a station of programs
  /// What `meridian doctor` finds on this host, as its JSON; none: the page says nothing of it.
  std::function<std::string()> examine_host;
  bool answers_actions = false;  ///< the operator does what the path waits for, in place of a PLC
  bool is_watching = false;      ///< the page has no buttons, and nothing that it says is passed on
};

/// What a panel says of itself when it is there.
struct PanelOpened {
  std::uint16_t port = 0;
  std::string refusal;  ///< why its identity may not command, so that it only watches; else empty
};

/// Serves the page of one machine until `is_ending`. Throws DdsError, ServerError and TokenError. Never touches motion: what a page asks for goes the way of `meridian
/// ctl`.
void run_panel(dds::Participant& participant, const PanelOptions& options,
               const std::atomic<bool>& is_ending,
               const std::function<void(const PanelOpened&)>& on_ready);

}  // namespace meridian::panel
