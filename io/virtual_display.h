#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace couture::io {

/// A private X server without a screen (Xvfb), to which the environment variable DISPLAY points
/// while the object lives. Pictures come out alike on a desktop, over ssh and in a container.
class VirtualDisplay {
  public:
    /// @throws FileError  if Xvfb is missing (names the package), does not start or takes no client
    VirtualDisplay();
    ~VirtualDisplay();
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  private:
    pid_t server_ = -1;
    /// Of a client that does nothing: the server ends with its last one, and VTK may close one
    /// connection before it opens the next.
    int connection_ = -1;
    std::optional<std::string> previous_;
};

}  // namespace couture::io
