// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/placing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"

namespace meridian::inspect {
namespace {

constexpr int kSpread = 1024;   // frames that the search begins with
constexpr int kBest = 12;       // of them, that steps begin from
constexpr int kFewPoses = 400;  // that a search looks at
constexpr int kRounds = 8;      // of search, each with the pose that was worst before
constexpr double kSmallest_mm = 0.05, kSmallest_rad = 1e-4;

/// Number `index` of the van der Corput sequence in `base`: spread evenly over 0 to 1.
double spread(int index, int base) {
  double value = 0, share = 1.0 / base;
  for (; index > 0; index /= base, share /= base) value += share * (index % base);
  return value;
}

std::vector<ProgramPose> few_of(const std::vector<ProgramPose>& poses) {
  const std::size_t step = std::max<std::size_t>(1, poses.size() / kFewPoses);
  std::vector<ProgramPose> few;
  double feed_time_s = 0;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    feed_time_s += poses[n].feed_time_s;
    if (n % step != 0) continue;
    few.push_back(poses[n]);
    few.back().feed_time_s = feed_time_s;
    feed_time_s = 0;
  }
  return few;
}

/// A frame as the search moves it: x, y, z and the turn.
using Location = std::array<double, 4>;

class Search {
 public:
  Search(const MachineModel& model, const PlacingBox& box, PlacingAim aim)
      : model_(model), box_(box), aim_(aim) {}

  [[nodiscard]] Location run(const std::vector<ProgramPose>& poses,
                             const std::vector<Location>& also) {
    struct Tried {
      Location location;
      double score;
    };
    std::vector<Tried> tried;
    const auto add = [&](const Location& location) {
      tried.push_back({location, score(location, poses)});
    };
    for (int n = 0; n < kSpread; ++n) {
      Location location{};
      for (std::size_t i = 0; i < 3; ++i) {
        constexpr std::array kBases = {2, 3, 5};
        location[i] = box_.low_mm[i] + spread(n, kBases[i]) * (box_.high_mm[i] - box_.low_mm[i]);
      }
      if (box_.may_turn) location[3] = 2 * std::numbers::pi * (spread(n, 7) - 0.5);
      add(location);
    }
    for (const Location& location : also) add(location);
    std::stable_sort(tried.begin(), tried.end(),
                     [](const Tried& a, const Tried& b) { return a.score > b.score; });
    Tried best = tried.front();
    for (std::size_t n = 0; n < std::min<std::size_t>(kBest, tried.size()); ++n) {
      Tried from = tried[n];
      climb(from.location, from.score, poses);
      if (from.score > best.score) best = from;
    }
    return best.location;
  }

  /// What the search makes large, of a machine with its workpiece where it fits so: the speed where
  /// that is the aim and there is room, else the score.
  [[nodiscard]] double worth(const MachineModel& there, const std::vector<ProgramPose>& poses,
                             const Fit& fit) const {
    constexpr double kAboveAnyScore = 2;
    if (aim_ == PlacingAim::kMargin || fit.margin < kTimeMargin) return fit.score;
    return kAboveAnyScore + 1 / (1 + estimated_time_s(there, poses, fit.branch));
  }

  [[nodiscard]] int frames() const noexcept { return frames_; }

 private:
  [[nodiscard]] double score(const Location& location, const std::vector<ProgramPose>& poses) {
    ++frames_;
    const MachineModel there = placed(model_, {location[0], location[1], location[2]}, location[3]);
    return worth(there, poses, fit_of(there, poses));
  }

  /// Steps along each direction as long as they gain, halved where none does.
  void climb(Location& at, double& best, const std::vector<ProgramPose>& poses) {
    Location step{};
    for (std::size_t i = 0; i < 3; ++i) step[i] = (box_.high_mm[i] - box_.low_mm[i]) / 8;
    step[3] = box_.may_turn ? std::numbers::pi / 8 : 0;
    const auto is_worth = [&] {
      return *std::max_element(step.begin(), step.begin() + 3) > kSmallest_mm ||
             step[3] > kSmallest_rad;
    };
    while (is_worth()) {
      bool has_gained = false;
      for (std::size_t i = 0; i < step.size(); ++i) {
        for (const double by : {step[i], -step[i]}) {
          Location next = at;
          next[i] += by;
          if (i < 3) next[i] = std::clamp(next[i], box_.low_mm[i], box_.high_mm[i]);
          if (next == at) continue;
          const double found = score(next, poses);
          if (!(found > best)) continue;
          best = found;
          at = next;
          has_gained = true;
        }
      }
      if (has_gained) continue;
      for (double& one : step) one *= 0.5;
    }
  }

  const MachineModel& model_;
  const PlacingBox& box_;
  const PlacingAim aim_;
  int frames_ = 0;
};

}  // namespace

MachineModel placed(MachineModel model, const std::array<double, 3>& origin_mm, double turn_rad) {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  Eigen::Matrix3d about_z;
  about_z << c, -s, 0, s, c, 0, 0, 0, 1;
  model.X_MW.rotation = about_z * model.X_MW.rotation;
  model.X_MW.origin_mm = Vector3(origin_mm[0], origin_mm[1], origin_mm[2]);
  return model;
}

PlacingBox widest_box(const MachineModel& model, const std::vector<ProgramPose>& poses) {
  constexpr int kSamples = 512;
  constexpr std::array kBases = {2, 3, 5, 7, 11, 13};
  Vector3 middle = Vector3::Zero();
  for (const ProgramPose& at : poses) {
    middle += model.X_MW.rotation * at.pose.tip / static_cast<double>(poses.size());
  }
  const MachineModel bare = placed(model, {0, 0, 0}, 0);
  PlacingBox box;
  box.low_mm.fill(std::numeric_limits<double>::infinity());
  box.high_mm.fill(-std::numeric_limits<double>::infinity());
  for (int n = 0; n < kSamples; ++n) {
    JointVector q{};
    for (int i = 0; i < model.joint_count; ++i) {
      const JointSpec& joint = model.joints[i];
      const double low = joint.is_endless ? -std::numbers::pi : joint.limits.travel_min;
      const double high = joint.is_endless ? std::numbers::pi : joint.limits.travel_max;
      q[i] = low + spread(n + 1, kBases[static_cast<std::size_t>(i)]) * (high - low);
    }
    const Vector3 tip = bare.X_MW.rotation * forward(bare, bare.tool_length_mm, q).tip;
    for (std::size_t i = 0; i < 3; ++i) {
      const double at = tip[static_cast<Eigen::Index>(i)] - middle[static_cast<Eigen::Index>(i)];
      box.low_mm[i] = std::min(box.low_mm[i], at);
      box.high_mm[i] = std::max(box.high_mm[i], at);
    }
  }
  return box;
}

Placing find_placing(const MachineModel& model, const std::vector<ProgramPose>& poses,
                     const PlacingBox& box, PlacingAim aim) {
  Search search(model, box, aim);
  std::vector<ProgramPose> few = few_of(poses);
  Placing best;
  double best_worth = 0;
  std::vector<Location> also;
  for (int round = 0; round < kRounds; ++round) {
    Location location = search.run(few, also);
    for (std::size_t i = 0; i < 3; ++i) location[i] = std::round(location[i] * 1e3) * 1e-3;
    const std::array<double, 3> origin = {location[0], location[1], location[2]};
    const MachineModel there = placed(model, origin, location[3]);
    const Fit fit = fit_of(there, poses);
    const double worth = search.worth(there, poses, fit);
    if (round == 0 || worth > best_worth) {
      best = {origin, location[3], fit, 0};
      best_worth = worth;
    }
    // The few had the margin that all have: no pose between them is worse.
    const Fit seen = fit_of(there, few);
    if (fit.margin > seen.margin - 1e-3) break;
    also.push_back(location);
    for (const ProgramPose& at : poses) {
      if (at.line == fit.line) few.push_back(at);
    }
  }
  best.frames = search.frames();
  return best;
}

}  // namespace meridian::inspect
