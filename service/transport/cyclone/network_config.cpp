// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/network_config.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "service/text/whole_file.hpp"

namespace meridian::dds {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

[[nodiscard]] std::string without_comments(std::string xml) {
  constexpr std::string_view kEnd = "-->";
  for (auto at = xml.find("<!--"); at != std::string::npos; at = xml.find("<!--", at)) {
    const auto end = xml.find(kEnd, at);
    xml.erase(at, end == std::string::npos ? end : end + kEnd.size() - at);
  }
  return xml;
}

[[nodiscard]] std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// The first word of `text`, up to one of `ends` or a blank.
[[nodiscard]] std::string first_word(std::string_view text, std::string_view ends) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const auto end = text.find_first_of(std::string(kBlanks).append(ends));
  return std::string(text.substr(0, end));
}

/// An element's begin: its attributes, and the text up to the next element.
struct Tag {
  std::string name;  ///< in lower case, as names of attributes
  std::map<std::string, std::string> attributes;
  std::string text;
};

/// Reads name="value" and name='value' from `xml` on; where the tag ends.
std::size_t read_attributes(std::string_view xml, std::size_t at, Tag& tag) {
  while (at < xml.size() && xml[at] != '>') {
    const auto equals = xml.find_first_of("=>", at);
    if (equals == std::string_view::npos || xml[equals] == '>') return equals;
    const auto open = xml.find_first_not_of(kBlanks, equals + 1);
    if (open == std::string_view::npos || (xml[open] != '"' && xml[open] != '\'')) {
      at = equals + 1;
      continue;
    }
    const auto close = xml.find(xml[open], open + 1);
    if (close == std::string_view::npos) return close;
    tag.attributes[lower(first_word(xml.substr(at, equals - at), "="))] =
        xml.substr(open + 1, close - open - 1);
    at = close + 1;
  }
  return at;
}

[[nodiscard]] std::vector<Tag> tags_of(std::string_view xml) {
  std::vector<Tag> out;
  for (auto at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at)) {
    Tag tag;
    tag.name = lower(first_word(xml.substr(++at), "/>"));
    at = read_attributes(xml, at + tag.name.size(), tag);
    if (at >= xml.size()) break;
    tag.text = first_word(xml.substr(at + 1), "<,");
    out.push_back(std::move(tag));
  }
  return out;
}

[[nodiscard]] bool is_loopback(const std::string& interface) {
  return interface == "lo" || interface == "::1" || interface.starts_with("127.");
}

/// The text of the file that one part of CYCLONEDDS_URI names.
[[nodiscard]] std::optional<std::string> read_part(std::string part) {
  constexpr std::string_view kScheme = "file://";
  if (part.starts_with(kScheme)) part.erase(0, kScheme.size());
  return text::read_whole(part);
}

}  // namespace

NetworkConfig read_network_config(const std::string& xml) {
  NetworkConfig out;
  const auto add = [](std::vector<std::string>& to, const std::string& one) {
    if (!one.empty() && one != "auto") to.push_back(one);
  };
  for (Tag& tag : tags_of(without_comments(xml))) {
    if (tag.name == "networkinterface") {
      const std::string& name = tag.attributes["name"];
      add(out.interfaces, name.empty() ? tag.attributes["address"] : name);
      out.is_chosen_by_cyclone |= name.empty() && tag.attributes["address"].empty();
    } else if (tag.name == "networkinterfaceaddress") {
      add(out.interfaces, tag.text);
    } else if (tag.name == "peer") {
      const std::string& address = tag.attributes["address"];
      add(out.peers, address.substr(0, address.find(':')));  // without a port
    } else if (tag.name == "allowmulticast") {
      const std::string allowed = lower(tag.text);
      out.has_multicast = allowed != "false" && allowed != "none";
    }
  }
  return out;
}

bool leaves_host(const NetworkConfig& config) {
  return config.is_chosen_by_cyclone || config.interfaces.empty() ||
         !std::all_of(config.interfaces.begin(), config.interfaces.end(), is_loopback);
}

bool leaves_host(const std::string& cyclone_uri) {
  if (cyclone_uri.find('<') != std::string::npos) {
    return leaves_host(read_network_config(cyclone_uri));
  }
  std::string all;
  std::istringstream parts(cyclone_uri);
  for (std::string part; std::getline(parts, part, ',');) {
    const auto text = read_part(part);
    if (!text) return true;
    all += *text;
  }
  return leaves_host(read_network_config(all));
}

}  // namespace meridian::dds
