// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/config_error.hpp"

#include <sstream>
#include <utility>

namespace meridian::config {
namespace {

std::string sentence(const ConfigFault& fault) {
  std::ostringstream text;
  text << fault.file;
  if (fault.line > 0) text << ':' << fault.line;
  text << ": ";
  if (fault.key.empty()) {
    text << fault.value;
  } else if (fault.value.empty()) {
    text << fault.key << " is missing";
  } else {
    text << fault.key << " = " << fault.value << " is refused";
  }
  if (!fault.allowed.empty()) text << "; allowed: " << fault.allowed;
  if (!fault.remedy.empty()) text << "; remedy: " << fault.remedy;
  return text.str();
}

}  // namespace

ConfigError::ConfigError(ConfigFault fault)
    : std::runtime_error(sentence(fault)), fault_(std::move(fault)) {}

}  // namespace meridian::config
