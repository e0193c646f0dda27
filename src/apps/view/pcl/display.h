// Whether there is a screen.
#pragma once

namespace depth_fusion {

// Throws Error, which says what to do, if no window can be opened: VTK would end the process.
void checkDisplay();

}  // namespace depth_fusion
