// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>

#include "service/transport/participant.hpp"

namespace meridian::dds {

/// A Cyclone entity that goes with its scope. For entities that exist only while something is made.
class Entity {
 public:
  /// Takes what a dds_create_... function returned; throws DdsError that begins with `what` where
  /// that is an error.
  Entity(const char* what, dds_entity_t handle) : handle_(handle) {
    if (handle < 0) throw DdsError(std::string(what) + ": " + dds_strretcode(-handle));
  }
  ~Entity() { dds_delete(handle_); }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  [[nodiscard]] dds_entity_t handle() const noexcept { return handle_; }

 private:
  dds_entity_t handle_;
};

struct QosDeleter {
  void operator()(dds_qos_t* qos) const noexcept { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

}  // namespace meridian::dds
