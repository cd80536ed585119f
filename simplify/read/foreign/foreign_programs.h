// The texts of steps.py, vtk.py and meshio.py, which CMake makes constants of.
#pragma once

namespace qtet {

extern const char* const kVtkProgram;     ///< steps.py and vtk.py
extern const char* const kMeshioProgram;  ///< steps.py and meshio.py

}  // namespace qtet
