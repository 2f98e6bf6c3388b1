// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <idl/cl.h>
#include <idl/drives.h>
#include <idl/operator.h>
#include <idl/status.h>

#include "service/transport/convert/messages.hpp"

/// Wire <-> core, both ways, field by field; nothing here checks. Texts longer than the wire holds
/// are cut, texts without an end are ended. Enumerations keep a value that they do not name:
/// whoever acts on one checks it. Proof: tests/unit/transport/convert_test.cpp.
namespace meridian::dds {

void to_wire(const Batch& message, meridian_wire_ClBatch& wire) noexcept;
void to_wire(const SessionRequest& message, meridian_wire_ClSession& wire) noexcept;
void to_wire(const Credit& message, meridian_wire_ClCredit& wire) noexcept;
void to_wire(const CommandRequest& message, meridian_wire_Command& wire) noexcept;
void to_wire(const Reply& message, meridian_wire_Reply& wire) noexcept;
void to_wire(const Jog& message, meridian_wire_Jog& wire) noexcept;
void to_wire(const Enabling& message, meridian_wire_Enabling& wire) noexcept;
void to_wire(const SetpointSample& message, meridian_wire_Setpoint& wire) noexcept;
void to_wire(const DriveCommand& message, meridian_wire_DriveCommand& wire) noexcept;
void to_wire(const DriveFeedback& message, meridian_wire_Feedback& wire) noexcept;
void to_wire(const Action& message, meridian_wire_Action& wire) noexcept;
void to_wire(const ActionDone& message, meridian_wire_ActionDone& wire) noexcept;
void to_wire(const Status& message, meridian_wire_Status& wire) noexcept;
void to_wire(const MachineInfo& message, meridian_wire_Machine& wire) noexcept;
void to_wire(const Latency& message, meridian_wire_Latency& wire) noexcept;

void from_wire(const meridian_wire_ClBatch& wire, Batch& message) noexcept;
void from_wire(const meridian_wire_ClSession& wire, SessionRequest& message);
void from_wire(const meridian_wire_ClCredit& wire, Credit& message);
void from_wire(const meridian_wire_Command& wire, CommandRequest& message);
void from_wire(const meridian_wire_Reply& wire, Reply& message);
void from_wire(const meridian_wire_Jog& wire, Jog& message) noexcept;
void from_wire(const meridian_wire_Enabling& wire, Enabling& message);
void from_wire(const meridian_wire_Setpoint& wire, SetpointSample& message) noexcept;
void from_wire(const meridian_wire_DriveCommand& wire, DriveCommand& message) noexcept;
void from_wire(const meridian_wire_Feedback& wire, DriveFeedback& message) noexcept;
void from_wire(const meridian_wire_Action& wire, Action& message);
void from_wire(const meridian_wire_ActionDone& wire, ActionDone& message);
void from_wire(const meridian_wire_Status& wire, Status& message);
void from_wire(const meridian_wire_Machine& wire, MachineInfo& message);
void from_wire(const meridian_wire_Latency& wire, Latency& message);

}  // namespace meridian::dds
