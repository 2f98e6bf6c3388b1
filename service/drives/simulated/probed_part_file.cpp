// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/probed_part.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::drives {
namespace {

constexpr config::Range kPosition_mm{-1e5, 1e5}, kLength_mm{1e-3, 1e5}, kAngle_deg{-360, 360};

[[nodiscard]] ProbedShape read_shape(config::Section& section, ProbedShape::Kind kind) {
  ProbedShape shape;
  shape.kind = kind;
  shape.origin_mm = to_vector(section.triple("origin_mm", kPosition_mm, "say where it lies"));
  if (kind != ProbedShape::Kind::kSphere) {
    const Array3 turn = section.triple_or("rotation_deg", {0, 0, 0}, kAngle_deg);
    shape.rotation = config::rotation_from_deg(turn[0], turn[1], turn[2]);
  }
  if (kind == ProbedShape::Kind::kBox) {
    shape.size_mm = to_vector(section.triple("size_mm", kPosition_mm, "say how far it reaches"));
  } else {
    shape.radius_mm = section.number("radius_mm", kLength_mm);
  }
  if (kind == ProbedShape::Kind::kBore) shape.depth_mm = section.number("depth_mm", kLength_mm);
  section.finish();
  return shape;
}

}  // namespace

ProbedPart parse_probed_part(std::string_view text, const std::string& name) {
  const toml::table table = config::parse_text(text, name);
  config::Section file(name, table);
  ProbedPart part;
  part.length_mm = file.number("length_mm", {0, 1e5}, "gauge line to the end of the stylus");
  part.ball_mm = file.number("ball_radius_mm", {1e-3, 1e3}, "of the stylus");
  const auto read_all = [&](const char* key, ProbedShape::Kind kind) {
    for (config::Section& section : file.sections_or(key)) {
      part.shapes.push_back(read_shape(section, kind));
    }
  };
  read_all("box", ProbedShape::Kind::kBox);
  read_all("sphere", ProbedShape::Kind::kSphere);
  read_all("bore", ProbedShape::Kind::kBore);
  file.finish();
  return part;
}

}  // namespace meridian::drives
