// SPDX-License-Identifier: Apache-2.0

/// What a stop may use in drawn situations: as reviewed. That it is safe, and hardly less than what
/// would be, is the business of feed_stop_margin_test.cpp; this notices any other change.
/// MERIDIAN_REGENERATE=1 prints the rows anew.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "service/core/planner/feed/stop/feed_stop_margin.hpp"
#include "unit/planner/feed/made_cells.hpp"

namespace meridian::test::feed_stop_margin_drawn {
namespace {

constexpr int kCells = 60;
constexpr double kShare = 1e-5;  // of a value, rows have six digits

/// Acceleration and jerk of a hold, its speed, those of a FaultStop, and of slow holds.
using Row = std::array<double, 8>;
constexpr Row kRows[] = {
    {1346.78, 46144.7, 32.2265, 3455.66, 209912, 43.2756, 1175.77, 479212},
    {1880.99, 49516, 1e+06, 4635.76, 300755, 1e+06, 1510.62, 750963},
    {1135.54, 39700.5, 30.1185, 3522.53, 328441, 1e+06, 1138.07, 345310},
    {1235.39, 87729.3, 1e+06, 2485.7, 410227, 1e+06, 942.539, 432617},
    {1405.49, 36752.9, 51.6591, 3570.06, 146678, 83.5156, 1654.44, 308177},
    {1233.05, 46000.4, 1e+06, 2473.84, 211149, 1e+06, 787.722, 225530},
    {1647.09, 53653.3, 1e+06, 3915.49, 303204, 1e+06, 1257.65, 317900},
    {1906.14, 66476.5, 52.5341, 4541.56, 266379, 74.4233, 1560.87, 267752},
    {758.574, 80659.1, 1e+06, 1601.6, 359557, 1e+06, 641.529, 577581},
    {1164.47, 46191.5, 26.5452, 2646.31, 188030, 1e+06, 984.186, 264367},
    {1214.14, 60614.6, 1e+06, 2189.89, 244055, 1e+06, 672.394, 244501},
    {1651.68, 49046.4, 1e+06, 3326.72, 207926, 1e+06, 1170.26, 266719},
    {0, 0, 0, 3191.09, 200346, 46.8146, 1283.45, 262189},
    {722.845, 28177.6, 84.9654, 3389.78, 181804, 84.9654, 1598.56, 317986},
    {1199.17, 42632.4, 1e+06, 4023.74, 243765, 1e+06, 1336.46, 311244},
    {1354.05, 34185.6, 73.9707, 3924.03, 180903, 73.9707, 1396.04, 209832},
    {952.873, 58403.6, 1e+06, 1692.47, 235312, 1e+06, 665.833, 395189},
    {1179.97, 61195.5, 1e+06, 2366.51, 246148, 1e+06, 749.528, 247219},
    {1538.69, 36080.5, 69.5145, 4005.48, 155227, 1e+06, 1408.22, 211455},
    {1014.71, 52752.1, 1e+06, 1707.36, 149351, 1e+06, 667.24, 231269},
    {1302.73, 47667.7, 1e+06, 3865.24, 419634, 1e+06, 1260.94, 461762},
    {1052.79, 33456.7, 1e+06, 2138.02, 201239, 1e+06, 613.8, 204650},
    {891.84, 31538.1, 1e+06, 3463.77, 153181, 1e+06, 1375.03, 237523},
    {1507.08, 28813.8, 1e+06, 3256.77, 134556, 1e+06, 1377.69, 246860},
    {1027.92, 50645.8, 1e+06, 2911.17, 220928, 1e+06, 0, 0},
    {1366.75, 124516, 1e+06, 2735.49, 498840, 1e+06, 1298.22, 1.13882e+06},
    {1182.64, 42530.6, 31.6082, 3084.21, 166880, 54.7876, 1127.13, 187015},
    {1573.81, 75489.9, 1e+06, 3303.63, 334229, 1e+06, 1180.35, 429717},
    {1604.77, 56248.3, 1e+06, 3097.06, 334575, 1e+06, 1046.01, 431466},
    {1272.94, 38950.3, 38.2687, 2071.97, 189299, 1e+06, 1043.46, 0},
    {1037.15, 39955.7, 25.0829, 2936.41, 159556, 50.1659, 1199.23, 159932},
    {1383.25, 67087.6, 1e+06, 2503.61, 269782, 1e+06, 769.65, 270181},
    {1153.94, 58348.5, 1e+06, 2263.88, 299016, 1e+06, 699.565, 305851},
    {850.331, 86938.2, 1e+06, 1589.67, 348170, 1e+06, 493.639, 348392},
    {859.44, 96697.3, 1.57133, 2250.14, 386026, 1e+06, 656.068, 391798},
    {1411.27, 68312.6, 1e+06, 2751.93, 275911, 1e+06, 1419.89, 445902},
    {1935.51, 42571.3, 82.5523, 4289.55, 204095, 1e+06, 1403.54, 222783},
    {1643.28, 85307.4, 1e+06, 3317.9, 355751, 1e+06, 1520.39, 622974},
    {1067.9, 78550.8, 1e+06, 2128.05, 314295, 1e+06, 672.341, 314322},
    {1534.55, 50153.8, 38.1646, 3954.19, 197787, 1e+06, 1282.58, 226269},
    {1372.95, 54363.6, 1e+06, 3344.76, 300362, 1e+06, 1095.47, 354556},
    {1485.38, 48776.4, 1e+06, 3148.01, 219082, 1e+06, 0, 0},
    {1736.56, 52061.3, 54.7872, 3774.54, 233056, 1e+06, 1225.98, 253714},
    {1437.05, 41576.4, 45.6747, 3214.13, 178154, 1e+06, 1040.28, 191012},
    {786.792, 52051.3, 1e+06, 1548.12, 247947, 1e+06, 547.916, 327237},
    {1960.3, 42729.1, 1e+06, 4195.47, 195722, 1e+06, 1363.61, 212404},
    {1441.74, 50200.1, 1e+06, 3381.98, 304249, 1e+06, 1218.51, 410666},
    {1278.34, 63798.5, 1e+06, 2547.57, 258405, 1e+06, 1295.31, 678791},
    {2331.82, 248938, 1e+06, 2852.95, 230303, 1e+06, 0, 0},
    {1060.68, 56108.8, 1e+06, 2125.82, 225986, 1e+06, 0, 0},
    {1670.73, 51655.8, 1e+06, 3444.09, 219509, 1e+06, 1104.27, 335390},
    {778.751, 55371.4, 1e+06, 1560.25, 239671, 1e+06, 1288.24, 352235},
    {1247.5, 39741.8, 34.9781, 2702.11, 190243, 34.9781, 1095.19, 205997},
    {1504.05, 53496.3, 1e+06, 3562.29, 300741, 1e+06, 0, 0},
    {1174.34, 31632.7, 41.0174, 2988.03, 161508, 1e+06, 1005.89, 0},
    {1545.46, 41022.5, 49.9238, 3717.59, 170358, 70.7254, 1494.14, 316803},
    {1045.76, 119428, 1e+06, 2107.92, 485718, 1e+06, 0, 0},
    {1463.9, 55056.6, 36.2624, 3669.86, 221003, 56.811, 1243.34, 251323},
    {1398.28, 42201.7, 1e+06, 3170.97, 217052, 1e+06, 1181.87, 306028},
    {1193.39, 31433.3, 1e+06, 3408.2, 167937, 1e+06, 1180.52, 214905},
};

/// Short cells in which two joints bend, each more or less evenly, from the `first` on.
void draw_cells(CellGrid& grid, std::mt19937& random, int first) {
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const double bend = real(0, 0.25), twist = real(0, 0.03), fast = real(40, 160);
  double x = 0;
  for (std::int64_t k = first; k < first + kCells; ++k) {
    FeedCell& cell = grid[k];
    cell.h = real(0.2, 0.5);
    cell.x = x;
    x += cell.h;
    cell.made_tight = random() % 4 == 0 ? real(0.6, 1) : 1;
    cell.bound = {};
    const auto draw = [&](int joint, double unit, CellBound::Sides& sides) {
      const double middle = real(-1, 1), off = real(0, 0.1);
      sides.up[joint] = unit * std::max(0.0, middle + off);
      sides.down[joint] = unit * std::max(0.0, off - middle);
    };
    for (const int joint : {0, 3}) {
      const double unit = joint == 0 ? 1 : 0.003;
      draw(joint, unit, cell.bound.d1);
      draw(joint, unit * bend, cell.bound.d2);
      draw(joint, unit * twist, cell.bound.d3);
    }
    cell.bound.rate = cell.bound.d1.up.max(cell.bound.d1.down);
    for (CellSample& at : cell.at) at.max_b = fast * fast * real(0.9, 1.4);
    cell.max_b = cell.at[0].max_b;
  }
}

/// The path of the seed begins with cell `first` of the grid.
Row grant(unsigned seed, int first = 0) {
  std::mt19937 random(seed);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  MadeCells cells(first + kCells);
  draw_cells(cells.grid, random, first);
  FeedStopMargin margin(cells.model);
  const int cell = first + static_cast<int>(real(0, 20));
  margin.begin(cells.grid,
               random() % 2 == 0 ? cell + static_cast<int>(real(3, 14)) : first + kCells);
  TimePiece time;
  for (int n = 0; n < 2; ++n) {  // the second is bounded by what the first got
    time = {};
    FeedPiece piece;
    piece.cell = cell + n;
    time.duration = real(1e-3, 6e-3);
    time.s0 = cells.grid[piece.cell].x;
    time.v = real(5, 100);
    time.a = random() % 3 == 0 ? 0 : real(-1500, 1500);
    time.k = random() % 2 == 0 ? 0 : real(-100, 100);
    time.is_tail = random() % 4 == 0;
    margin.grant(piece, time);
  }
  return {time.stop_accel,      time.stop_jerk,      std::min(time.stop_velocity, 1e6),
          time.fault_accel,     time.fault_jerk,     std::min(time.fault_velocity, 1e6),
          time.slow_stop_accel, time.slow_fault_jerk};
}

TEST(FeedStopMarginDrawn, IsWhatItWasWhenTheRowsWereReviewed) {
  const bool is_printing = std::getenv("MERIDIAN_REGENERATE") != nullptr;
  unsigned seed = 1;
  for (const Row& row : kRows) {
    const Row got = grant(seed);
    for (std::size_t n = 0; n < row.size(); ++n) {
      EXPECT_NEAR(got[n], row[n], kShare * std::abs(row[n])) << "seed " << seed << " value " << n;
    }
    if (is_printing) {
      for (std::size_t n = 0; n < got.size(); ++n) {
        std::printf("%s%.6g", n == 0 ? "    {" : ", ", got[n]);
      }
      std::printf("},\n");
    }
    ++seed;
  }
}

TEST(FeedStopMarginDrawn, IsTheSameBitForBitWhereverBlocksOfCellsBegin) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    const Row begun_with_a_block = grant(seed);
    for (int first = 1; first < CellBlock::kCells; ++first) {
      EXPECT_EQ(grant(seed, first), begun_with_a_block) << "seed " << seed << " first " << first;
    }
  }
}

}  // namespace
}  // namespace meridian::test::feed_stop_margin_drawn
