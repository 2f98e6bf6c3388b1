// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics of the shipped machines, ours and Orocos KDL's numerical solvers, in one run
// on the same poses: compare_kdl [POSES]. KDL is a comparison target and no part of the product.
//
// KDL is given every advantage: the whole frame of the tool, although a CL file has no spin about
// its axis; lengths in metres, weights of one. It starts 10 mm and 3 degrees beside the answer, as
// one who follows a path does, or at home, as one who begins. Both times are processor time of this
// thread. Exit code 1 where ours leaves a pose out.
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <memory>
#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "service/host/probe/budgets.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/picture/skeleton.hpp"
#include "support/cpu_time.hpp"

namespace meridian {
namespace {

using inspect::Side;
using inspect::Skeleton;

constexpr double kMetre_mm = 1000;
constexpr double kTip_mm = 1e-3, kAxis_rad = 1e-6;   // what counts as solved
constexpr double kAside_mm = 10, kAside_rad = 0.05;  // where solvers start

KDL::Vector kdl(const Vector3& v, double scale = 1) {
  return {v[0] * scale, v[1] * scale, v[2] * scale};
}

/// The machine as a product of exponentials: every joint in the frame of the kinematics.
KDL::Chain chain_of(const Skeleton& s, const MachineModel& model) {
  KDL::Chain chain;
  for (std::size_t i = 0; i < s.joints.size(); ++i) {
    const auto& j = s.joints[i];
    const Vector3 axis = j.side == Side::kTable ? Vector3(-j.direction) : j.direction;
    const KDL::Joint joint(model.joints[static_cast<std::size_t>(j.joint)].name,
                           kdl(j.point, 1 / kMetre_mm), kdl(axis),
                           j.is_rotary ? KDL::Joint::RotAxis : KDL::Joint::TransAxis);
    KDL::Frame end = KDL::Frame::Identity();
    if (i + 1 == s.joints.size()) {
      const Vector3 x = s.axis.unitOrthogonal();
      end = KDL::Frame(KDL::Rotation(kdl(x), kdl(s.axis.cross(x)), kdl(s.axis)),
                       kdl(s.tip, 1 / kMetre_mm));
    }
    chain.addSegment(KDL::Segment(joint, end));
  }
  return chain;
}

KDL::JntArray kdl_joints(const Skeleton& s, const JointVector& q) {
  KDL::JntArray out(static_cast<unsigned>(s.joints.size()));
  for (unsigned i = 0; i < s.joints.size(); ++i) {
    const auto at = static_cast<std::size_t>(s.joints[i].joint);
    const double distance = q[at] - s.joints_there[at];
    out(i) = s.joints[i].is_rotary ? distance : distance / kMetre_mm;
  }
  return out;
}

JointVector joints_of(const Skeleton& s, const KDL::JntArray& q) {
  JointVector out{};
  for (unsigned i = 0; i < s.joints.size(); ++i) {
    const auto at = static_cast<std::size_t>(s.joints[i].joint);
    out[at] = s.joints_there[at] + (s.joints[i].is_rotary ? q(i) : q(i) * kMetre_mm);
  }
  return out;
}

struct Case {
  ToolPose pose;
  KDL::Frame frame;
  KDL::JntArray start;
  JointVector reference;
  int branch = 0;
};

struct Error {
  double tip_mm = 0, axis_rad = 0;
  [[nodiscard]] bool is_solved() const { return tip_mm <= kTip_mm && axis_rad <= kAxis_rad; }
};

Error error_of(const MachineModel& model, const JointVector& q, const ToolPose& want) {
  const ToolPose is = forward(model, model.tool_length_mm, q);
  if (!is.tip.allFinite() || !is.axis.allFinite()) return {1e9, 1e9};
  return {(is.tip - want.tip).norm(),
          std::atan2(is.axis.cross(want.axis).norm(), is.axis.dot(want.axis))};
}

/// The joint whose zero makes the machine singular: tilt of five-axis machines, elbow of robots.
std::size_t singular_joint(const MachineModel& model) {
  if (model.family == MachineFamily::kRobot) return robot::kElbow;
  if (model.family == MachineFamily::kLai) return lai::kTheta2;
  return static_cast<std::size_t>(model.chain.b.joint);
}

enum class Draw {
  kFollowed,      ///< anywhere in travel, from beside the answer
  kNearSingular,  ///< the same, the singular joint 1e-1 to 1e-6 rad beside zero
  kFromHome       ///< anywhere in travel, from home
};

/// Poses inside travel, with the joints that solvers start from.
std::vector<Case> cases_of(const MachineModel& model, const Skeleton& s, const KDL::Chain& chain,
                           Draw kind, int count) {
  std::mt19937_64 draw(1);
  KDL::ChainFkSolverPos_recursive fk(chain);
  std::vector<Case> out;
  for (int n = 0; n < count; ++n) {
    JointVector q{};
    Case c;
    for (std::size_t i = 0; i < s.joints.size(); ++i) {
      const JointSpec& joint = model.joints[i];
      const double low = joint.is_endless ? -3 : joint.limits.travel_min;
      const double high = joint.is_endless ? 3 : joint.limits.travel_max;
      q[i] = std::uniform_real_distribution<double>(low, high)(draw);
    }
    if (kind == Draw::kNearSingular) {
      q[singular_joint(model)] =
          -std::pow(10, -1 - 5 * std::uniform_real_distribution<double>(0, 1)(draw));
    }
    c.reference = q;
    for (std::size_t i = 0; i < s.joints.size(); ++i) {
      const double aside = model.joints[i].is_rotary ? kAside_rad : kAside_mm;
      c.reference[i] += draw() % 2 == 0 ? aside : -aside;
      if (kind == Draw::kFromHome) c.reference[i] = model.joints[i].home;
    }
    if (model.joint_count == 6) c.reference[robot::kSpin] = q[robot::kSpin];
    c.pose = forward(model, model.tool_length_mm, q);
    fk.JntToCart(kdl_joints(s, q), c.frame);
    c.start = kdl_joints(s, c.reference);
    double nearest = 1e9;
    for (int branch = 0; branch < branch_count(model); ++branch) {
      const auto solution = solve(model, model.tool_length_mm, c.pose, branch, q);
      if (solution.status == SolveStatus::kUnreachable) continue;
      double distance = 0;
      for (std::size_t i = 0; i < q.size(); ++i) distance += std::abs(solution.q[i] - q[i]);
      if (distance < nearest) c.branch = branch;
      nearest = std::min(nearest, distance);
    }
    out.push_back(std::move(c));
  }
  return out;
}

double now_ns() { return 1e9 * test::cpu_s(); }

struct Score {
  double ns = 0;  ///< per solve
  int solved = 0;
  Error worst;  ///< of those solved

  void add(const Error& error) {
    if (!error.is_solved()) return;
    ++solved;
    worst = {std::max(worst.tip_mm, error.tip_mm), std::max(worst.axis_rad, error.axis_rad)};
  }
};

Score ours(const MachineModel& model, const std::vector<Case>& cases) {
  constexpr int kRounds = 50;
  std::vector<JointVector> joints(cases.size());
  const double begin = now_ns();
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const Case& c = cases[i];
      joints[i] = solve(model, model.tool_length_mm, c.pose, c.branch, c.reference).q;
    }
  }
  Score out;
  out.ns = (now_ns() - begin) / (kRounds * static_cast<double>(cases.size()));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    out.add(error_of(model, joints[i], cases[i].pose));
  }
  return out;
}

Score theirs(KDL::ChainIkSolverPos& solver, const Skeleton& s, const MachineModel& model,
             const std::vector<Case>& cases) {
  std::vector<KDL::JntArray> joints(cases.size(), KDL::JntArray(cases[0].start.rows()));
  const double begin = now_ns();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    (void)solver.CartToJnt(cases[i].start, cases[i].frame, joints[i]);
  }
  Score out;
  out.ns = (now_ns() - begin) / static_cast<double>(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    out.add(error_of(model, joints_of(s, joints[i]), cases[i].pose));
  }
  return out;
}

void print(const char* solver, const Score& score, std::size_t poses, double ours_ns) {
  std::printf("    %-9s %11.1f ns  %6.1f %% solved, worst %.1e mm %.1e rad", solver, score.ns,
              100.0 * score.solved / static_cast<double>(poses), score.worst.tip_mm,
              score.worst.axis_rad);
  if (score.ns != ours_ns) std::printf("  %6.0f times our time", score.ns / ours_ns);
  std::printf("\n");
}

/// Whether ours solved every pose.
bool compare(const std::string& file, int count) {
  const MachineModel model = config::load_machine(file);
  const Skeleton s = inspect::skeleton_of(model);
  const KDL::Chain chain = chain_of(s, model);
  bool is_whole = true;
  constexpr const char* kWords[] = {"anywhere in travel, from beside the answer",
                                    "the same, 1e-1 to 1e-6 rad beside the singular set",
                                    "anywhere in travel, from home"};
  for (const Draw kind : {Draw::kFollowed, Draw::kNearSingular, Draw::kFromHome}) {
    const std::vector<Case> cases = cases_of(model, s, chain, kind, count);
    std::printf("  %s, %s\n", model.name.c_str(), kWords[static_cast<int>(kind)]);
    const Score own = ours(model, cases);
    print("Meridian", own, cases.size(), own.ns);
    const Eigen::Matrix<double, 6, 1> weights = Eigen::Matrix<double, 6, 1>::Ones();
    KDL::ChainIkSolverPos_LMA lma(chain, weights, 1e-10);
    print("KDL LMA", theirs(lma, s, model, cases), cases.size(), own.ns);
    KDL::ChainFkSolverPos_recursive fk(chain);
    KDL::ChainIkSolverVel_pinv velocity(chain);
    KDL::ChainIkSolverPos_NR newton(chain, fk, velocity, 500, 1e-10);
    print("KDL NR", theirs(newton, s, model, cases), cases.size(), own.ns);
    is_whole = is_whole && own.solved == count;
  }
  return is_whole;
}

}  // namespace
}  // namespace meridian

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::max(1, std::atoi(argv[1])) : 500;
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(MERIDIAN_SOURCE_DIR "/deploy/machines")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::printf("solved: tip within 1e-3 mm, axis within 1e-6 rad; %d poses each, processor time\n",
              count);
  std::printf("budgets of ours, followed along a path:");
  for (const char* const name :
       {"inverse_kinematics_lai", "inverse_kinematics_family", "inverse_kinematics_robot"}) {
    const meridian::probe::Budget budget = meridian::probe::load_budget(name);
    std::printf(" %s %s;", budget.what.c_str(), bound_text(budget).c_str());
  }
  std::printf("\n");
  bool is_whole = true;
  for (const std::string& file : files) is_whole = meridian::compare(file, count) && is_whole;
  return is_whole ? 0 : 1;
}
