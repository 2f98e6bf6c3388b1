// SPDX-License-Identifier: Apache-2.0

/// What must not pass: a cycle function that allocates, throws, locks and prints, one level down.

#include <cmath>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace {

std::mutex mutex;

[[gnu::noinline]] double sum_of_roots(int count) {
  const std::lock_guard lock(mutex);
  std::vector<double> roots;
  for (int i = 0; i < count; ++i) {
    roots.push_back(std::pow(i, 0.3));
  }
  double sum = 0;
  for (const double root : roots) {
    sum += root;
  }
  if (sum < 0) {
    throw std::runtime_error("negative");
  }
  std::printf("%f\n", sum);
  return sum;
}

}  // namespace

extern "C" double meridian_fence_root(int count) { return sum_of_roots(count); }

/// Not reached from the root: what it calls must not count against the root.
extern "C" double meridian_fence_other(double x) { return std::tgamma(x); }
