// How a program must hold OpenCV so that a picture gives the same bits everywhere.
#pragma once

namespace understudy::vision {

/// One thread, and only instructions that every processor of 64 bits has: with others the smoothed picture
/// differs in the last bits, and with it where a spot is found. For the whole process, before its first
/// picture; the command and the Python module do it as they start.
void hold_opencv_to_plain_instructions();

}  // namespace understudy::vision
