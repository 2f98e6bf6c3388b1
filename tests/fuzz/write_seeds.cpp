// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fuzz/fuzz_targets.hpp"

/// write_seeds FOLDER MACHINES: what fuzzing begins with, a folder a target.
int main(int argc, char** argv) {
  using namespace meridian::fuzz;
  if (argc != 3) {
    std::fprintf(stderr, "write_seeds FOLDER MACHINES\n");
    return 2;
  }
  const auto write = [&](const char* target, const Seeds& seeds) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / target;
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      std::ofstream file(folder / ("seed-" + std::to_string(i)), std::ios::binary);
      file.write(reinterpret_cast<const char*>(seeds[i].data()),
                 static_cast<std::streamsize>(seeds[i].size()));
    }
  };
  write("cl", cl_seeds());
  write("machine", machine_seeds(argv[2]));
  write("nc", nc_seeds());
  write("wire", wire_seeds());
  return 0;
}
