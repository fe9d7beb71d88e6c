#pragma once

namespace couture::drivers {

/// From now on Ctrl-C (SIGINT) and SIGTERM end the program with exit code 130, whatever it is
/// doing, and leave no half-written file.
void exit_cleanly_on_interrupt();

}  // namespace couture::drivers
