#pragma once

#include <unistd.h>

#include <cstddef>
#include <fstream>

namespace exemplar::test_support {

/// Memory of this process; 0 where there is no /proc.
inline std::size_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t total = 0, resident = 0;
    file >> total >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace exemplar::test_support
