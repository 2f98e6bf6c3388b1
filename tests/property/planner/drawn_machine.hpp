// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"

/// Machines that nobody shipped.
namespace meridian::test {

/// The text of a machine file, drawn from a seed: a chain of any three slides and any two rotary
/// joints, an articulated robot or the machine of Lai et al., with limits, tolerances, travel and
/// offsets from a small mill's to a gantry's. The loader may refuse what was drawn.
class DrawnMachine {
 public:
  explicit DrawnMachine(std::uint32_t seed) : engine_(seed) {
    put_machine("drawn-" + std::to_string(seed));
    const double family = uniform(0, 1);
    if (family < 0.65) {
      put_chain();
    } else if (family < 0.8) {
      put_lai();
    } else {
      put_robot(family < 0.9);
    }
    put_rules();
  }

  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  /// How far, fast and hard a joint goes, in its own unit, and the unit's name in keys.
  struct Drive {
    const char* unit;
    double low, high;  ///< travel; equal: endless
    double velocity, acceleration, jerk, home = 0;
  };

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }
  bool chance(double p) { return uniform(0, 1) < p; }

  static std::string array_of(const Vector3& v) {
    std::ostringstream out;
    out.precision(17);
    out << "[" << v[0] << ", " << v[1] << ", " << v[2] << "]";
    return out.str();
  }
  template <class Value>
  void put(const char* key, const Value& value) {
    text_ << key << " = " << value << "\n";
  }

  void put_machine(const std::string& name) {
    text_.precision(17);
    text_ << "[machine]\nname = \"" << name << "\"\ncycle_us = 1000\n";
    put("max_feed_mm_per_min", log_uniform(3000, 200000));
    put("approach_feed_mm_per_min", log_uniform(100, 10000));
    put("clearance_mm", uniform(0, 100));
    put("tool_length_mm", uniform(0, 300));
    if (chance(0.3)) put("override_ramp_s", log_uniform(1, 1000));
  }

  void put_drive(const Drive& drive) {
    const std::string unit = drive.unit;
    const auto put_in_unit = [&](const std::string& key, double value) {
      text_ << key << "_" << value_unit(unit, key) << " = " << value << "\n";
    };
    if (drive.low == drive.high) {
      text_ << "endless = true\n";
    } else {
      text_ << "travel_" << unit << " = [" << drive.low << ", " << drive.high << "]\n";
    }
    const double fault = chance(0.3) ? 1 : uniform(1, 4);
    put_in_unit("velocity", drive.velocity);
    put_in_unit("acceleration", drive.acceleration);
    put_in_unit("jerk", drive.jerk);
    put_in_unit("fault_acceleration", fault * drive.acceleration);
    put_in_unit("fault_jerk", fault * drive.jerk);
    text_ << "following_error_" << unit << " = 5\nhome_" << unit << " = " << drive.home << "\n";
  }

  static std::string value_unit(const std::string& unit, const std::string& key) {
    const bool is_velocity = key == "velocity";
    const bool is_jerk = key.find("jerk") != std::string::npos;
    return unit + (is_velocity ? "_per_s" : is_jerk ? "_per_s3" : "_per_s2");
  }

  /// With less jerk the rounding of C within 1e-8 rad of the pole, 1e-8 rad and 2 nm where slides
  /// make up for it, takes all of it.
  Drive slide() {
    constexpr double kMinJerk = 20000;
    const double a = log_uniform(300, 20000), half = chance(0.7) ? 5000 : uniform(300, 1000);
    const double j = std::max(kMinJerk, a * log_uniform(5, 100));
    return {"mm", -half, half, log_uniform(50, 2000), a, j};
  }
  Drive rotary(double low, double high, double home = 0) {
    constexpr double kMinJerk = 5000;
    const double a = log_uniform(50, 10000), j = std::max(kMinJerk, a * log_uniform(5, 100));
    return {"deg", low, high, log_uniform(10, 1500), a, j, home};
  }
  Drive turntable() {
    if (chance(0.6)) return rotary(0, 0);
    const double half = uniform(150, 720);
    return rotary(-half, half);
  }

  /// A third of them go no farther than some degrees, or not at all, past the pole.
  Drive tilt() {
    double low = -uniform(60, 200), high = uniform(60, 200);
    if (chance(0.35)) (chance(0.5) ? low : high) *= chance(0.2) ? 0 : uniform(0, 0.3);
    return rotary(low, high);
  }

  Vector3 misaligned(const Vector3& axis) {
    if (!is_measured_) return axis;
    const double off = log_uniform(1e-6, 1e-2);
    return axis + off * Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  }

  /// The axis about which the tool tilts away from z.
  Vector3 tilt_axis() {
    const double kind = uniform(0, 1);
    if (kind < 0.35) return Vector3(1, 0, 0);
    if (kind < 0.7) return Vector3(0, 1, 0);
    if (kind < 0.85) return Vector3(0, 1, 1);
    const double azimuth = uniform(-3, 3), tilt = uniform(0.7, 1.57);
    return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
  }

  void put_chain() {
    is_measured_ = chance(0.3);
    std::vector<std::string> names = {"X", "Y", "Z"};
    std::shuffle(names.begin(), names.end(), engine_);
    const auto first = static_cast<std::size_t>(uniform(0, 4));
    names.insert(names.begin() + static_cast<std::ptrdiff_t>(first), "C");
    const auto second = static_cast<std::size_t>(uniform(static_cast<double>(first) + 1, 5));
    names.insert(names.begin() + static_cast<std::ptrdiff_t>(second), "T");
    const int tables = static_cast<int>(uniform(0, 6));
    text_ << "[kinematics]\nfamily = \"chain\"\nchain = [";
    for (const std::string& name : names) text_ << '"' << name << "\", ";
    text_ << "]\ntool_axis = [0, 0, 1]\n";
    if (is_measured_) text_ << "measured = true\n";
    const double gauge = uniform(50, 600);
    put("gauge_mm", array_of({uniform(-50, 50), uniform(-50, 50), gauge}));
    for (std::size_t n = 0; n < names.size(); ++n) {
      put_joint(names[n], static_cast<int>(n) < tables, gauge);
    }
  }

  void put_joint(const std::string& name, bool is_table, double gauge) {
    const bool is_rotary = name == "C" || name == "T";
    text_ << "[joints." << name << "]\nkind = \"" << (is_rotary ? "rotary" : "linear")
          << "\"\nside = \"" << (is_table ? "table" : "head") << "\"\n";
    if (!is_rotary) {
      const int axis = name[0] - 'X';
      const Vector3 along(axis == 0, axis == 1, axis == 2);
      put("direction", array_of((chance(0.3) ? -1.0 : 1.0) * misaligned(along)));
      return put_drive(slide());
    }
    const bool is_c = name == "C";
    const bool is_pole_level = is_c && chance(0.1);
    const Vector3 c_axis = is_pole_level ? Vector3(1, 0, 0) : Vector3(0, 0, 1);
    put("direction",
        array_of((chance(0.3) ? -1.0 : 1.0) * misaligned(is_c ? c_axis : tilt_axis())));
    put("point_mm", array_of({uniform(-80, 80), uniform(-80, 80),
                              is_table ? uniform(-150, 50) : gauge + uniform(0, 200)}));
    put_drive(is_c ? turntable() : tilt());
  }

  void put_lai() {
    text_ << "[kinematics]\nfamily = \"lai\"\n";
    for (const char* key : {"b1_mm", "a2_mm", "a3_mm", "l3_mm", "l4_mm", "b5_mm", "l5_mm"}) {
      put(key, uniform(0, 400));
    }
    for (const char* name : {"b3", "b2", "b4"}) {
      text_ << "[joints." << name << "]\nnc_word = \""
            << "XYZ"[name[1] == '3'   ? 0
                     : name[1] == '2' ? 1
                                      : 2]
            << "\"\n";
      put_drive(slide());
    }
    text_ << "[joints.theta1]\nnc_word = \"C\"\n";
    put_drive(turntable());
    text_ << "[joints.theta2]\nnc_word = \"B\"\n";
    put_drive(tilt());
  }

  void put_robot(bool is_five) {
    const double arm = uniform(500, 1500);
    text_ << "[kinematics]\nfamily = \"" << (is_five ? "robot5" : "robot6") << "\"\n";
    put("shoulder_height_mm", uniform(100, 800));
    put("upper_arm_mm", arm);
    put("forearm_mm", arm * uniform(0.7, 1.3));
    if (chance(0.7)) {  // the others have the part at the base, and the shoulder's singularity
      const double azimuth = uniform(-3, 3), off = arm * uniform(0.4, 1.2);
      part_ = {off * std::cos(azimuth), off * std::sin(azimuth), arm * uniform(-0.3, 0.3)};
    }
    put("wrist_mm", uniform(20, 250));
    const std::array<const char*, 3> five = {"pitch", "tilt", nullptr},
                                     six = {"roll", "bend", "spin"};
    int number = 0;
    const auto put_named = [&](const char* name, const Drive& drive) {
      text_ << "[joints." << name << "]\nnc_word = \"J" << ++number << "\"\n";
      put_drive(drive);
    };
    put_named("yaw", rotary(-uniform(150, 185), uniform(150, 185)));
    put_named("shoulder", rotary(-uniform(30, 90), uniform(110, 170), 60));
    put_named("elbow", rotary(-170, -2, -90));
    for (const char* name : is_five ? five : six) {
      if (name == nullptr) continue;
      const double half = uniform(120, 350);
      put_named(name, rotary(-half, half, 30));
    }
  }

  void put_rules() {
    text_ << "[tolerances]\n";
    put("tip_mm", log_uniform(0.002, 0.5));
    put("axis_deg", log_uniform(0.01, 2));
    text_ << "[pole]\npolicy = \"" << (chance(0.8) ? "ease" : "exact") << "\"\n";
    if (chance(0.3)) put("axis_deg", log_uniform(0.02, 3));
    if (chance(0.4)) {
      text_ << "[rewind]\npolicy = \"retract\"\n";
      put("retract_mm", uniform(5, 200));
    }
    text_ << "[frame]\n";
    const Vector3 beside{uniform(-50, 50), uniform(-50, 50), uniform(-50, 50)};
    put("origin_mm", array_of(part_ + beside));
    const double turn = chance(0.5) ? 0 : 1;
    put("rotation_deg",
        array_of({turn * uniform(-20, 20), turn * uniform(-20, 20), uniform(-180, 180)}));
  }

  std::mt19937_64 engine_;
  std::ostringstream text_;
  bool is_measured_ = false;
  Vector3 part_ = Vector3::Zero();  ///< middle of where it may lie, mm
};

/// The machine of a seed; none where the loader refuses it.
[[nodiscard]] inline std::optional<MachineModel> drawn_machine(std::uint32_t seed) {
  try {
    return config::parse_machine(DrawnMachine(seed).text(), "drawn.toml");
  } catch (const config::ConfigError&) {
    return std::nullopt;
  }
}

}  // namespace meridian::test
