// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How near the pole a path is treated otherwise, in tolerances of its axis, and how its redundant
/// joint is followed there. Source: docs/motion.md, section 10.
namespace meridian {

/// Nearer, the path counts as on the pole.
inline constexpr double kOnPoleTolerances = 0.2;
/// Nearer, the redundant joint of a robot may rest where the machine stops.
inline constexpr double kStopTolerances = 0.99;
/// Nearer, a smooth run may go another route than the exact one, and change the branch; minima of
/// the distance that are farther off leave that no room.
inline constexpr double kZoneTolerances = 2.5;
/// Nearer, another minimum behind a place decides for itself.
inline constexpr double kOtherTolerances = 3;

/// Of the redundant joint between two places at which its winding is followed.
inline constexpr double kMaxFollowed_rad = 0.5;
/// Places are no nearer to each other than that, however far it turns between them.
inline constexpr double kMinFollowed_mm = 1e-8;

}  // namespace meridian
