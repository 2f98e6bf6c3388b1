// SPDX-License-Identifier: Apache-2.0
#include "service/host/process/programs.hpp"

#include <cstdlib>
#include <stdexcept>
#include <system_error>

namespace meridian::process {
namespace {

namespace fs = std::filesystem;

[[nodiscard]] fs::path running_program() { return fs::read_symlink("/proc/self/exe"); }

}  // namespace

fs::path program_beside(const std::string& name) {
  fs::path path = running_program().parent_path() / name;
  if (!fs::exists(path)) {
    throw std::runtime_error(path.string() + " is missing: it is installed beside this program");
  }
  return path;
}

fs::path shipped_file(const std::string& name) {
  const fs::path program = running_program();
  if (const char* const share = std::getenv("MERIDIAN_SHARE"); share != nullptr) {
    if (fs::exists(fs::path(share) / name)) return fs::path(share) / name;
  }
  for (fs::path folder = program.parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* const kind : {"share/meridian", "deploy"}) {
      if (fs::exists(folder / kind / name)) return folder / kind / name;
    }
  }
  throw std::runtime_error(name + " is not found in share/meridian or deploy in folders above " +
                           program.string());
}

ScratchFolder::ScratchFolder() {
  std::string name = (fs::temp_directory_path() / "meridian-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("no folder can be made in " + fs::temp_directory_path().string());
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace meridian::process
