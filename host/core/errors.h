#pragma once

#include <stdexcept>
#include <string>

namespace exemplar {

/// Base of every error Exemplar throws. The message is one line that names the file or element and says how to fix
/// it.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A mesh file or mesh that cannot be used: unreadable, malformed, empty, not finite.
class MeshError : public Error {
  public:
    using Error::Error;
};

/// A label file, list file, corpus or cached data that cannot be used.
class DataError : public Error {
  public:
    using Error::Error;
};

/// A model file that is damaged, truncated, newer than this program, or made for other features.
class ModelError : public Error {
  public:
    using Error::Error;
};

/// A Vulkan device that is missing, lost, or whose limits are exceeded.
class DeviceError : public Error {
  public:
    using Error::Error;
};

/// A shader whose interface does not match what the program binds.
class ShaderError : public Error {
  public:
    using Error::Error;
};

/// A wrong argument on the command line or in a call.
class UsageError : public Error {
  public:
    using Error::Error;
};

/// The user pressed Ctrl-C, or the work was canceled; thrown by check_interrupt().
class Interrupted : public Error {
  public:
    Interrupted() : Error("interrupted") {}
};

}  // namespace exemplar
