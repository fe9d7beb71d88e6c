#pragma once

#include <memory>
#include <string>

namespace couture::io {

/// Takes what VTK would print of errors while it lives; several of its objects report no other way.
class VtkMessages {
  public:
    VtkMessages();
    ~VtkMessages();
    VtkMessages(const VtkMessages&) = delete;
    VtkMessages& operator=(const VtkMessages&) = delete;

    [[nodiscard]] bool has_any() const;
    /// The first message without the place in VTK's sources, or "nothing".
    [[nodiscard]] std::string first() const;

  private:
    struct Capture;
    std::unique_ptr<Capture> capture_;
};

}  // namespace couture::io
