// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/hal_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace meridian::hal {

HalMemory::HalMemory(const std::string& machine) {
  const std::string name = MERIDIAN_HAL_FILE + machine;
  const int file = ::shm_open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  const bool is_there = file >= 0 && ::ftruncate(file, sizeof(meridian_hal_shared)) == 0;
  void* const memory = is_there ? ::mmap(nullptr, sizeof(meridian_hal_shared),
                                         PROT_READ | PROT_WRITE, MAP_SHARED, file, 0)
                                : MAP_FAILED;
  const std::string reason = std::strerror(errno);
  if (file >= 0) ::close(file);
  if (memory == MAP_FAILED) {
    throw std::runtime_error("shared memory /dev/shm" + name + ": " + reason +
                             "; start meridian-hal and HAL as the same user");
  }
  shared_ = static_cast<meridian_hal_shared*>(memory);
}

HalMemory::~HalMemory() { ::munmap(shared_, sizeof *shared_); }

}  // namespace meridian::hal
