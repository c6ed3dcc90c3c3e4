// The program of what an interrupted print has not laid yet (docs/drive.md).
#pragma once

#include <optional>

#include "control/resume/laid_filament.h"
#include "geometry/mesh.h"
#include "machine/description.h"
#include "toolpath/program.h"

namespace understudy::control {

/// Where a print begins again.
struct Restart {
  std::size_t step = 0;    ///< of the whole program: a print step
  double done = 0;         ///< share of it that is laid, 0 to below 1
  double prime = 0;        ///< [m] of filament, back to the nozzle after what was drawn back
  Vec3 offset_W{0, 0, 0};  ///< [m], by which gap control had shifted the program
};

struct ResumedProgram {
  toolpath::Program program;
  std::size_t kept = 0;  ///< its step that is the rest of Restart::step
};

/// Goes from home to a point above the restart along the tool axis, down, primes, and prints what is left.
/// Above is the nearest of 10, 20, 40 mm from which the way to home, and to it, keeps the tip 5 mm from
/// `part` (which may be null) and from the beads that are laid. Throws InputError where none does, and for
/// programs of rotary words.
ResumedProgram resumed_program(const toolpath::Program& whole, const machine::MachineDescription& machine,
                               const geometry::Mesh* part, const Restart& restart);

/// Where a print goes on that `cut` tells of; `begun` is where that print itself began, when it was resumed.
/// Throws InputError naming `file` when no bead was begun or all are laid.
Restart restart_after(const CutRecord& cut, const std::string& file, const toolpath::Program& whole,
                      const machine::MachineDescription& machine, const geometry::Mesh* part,
                      const std::optional<Restart>& begun);

/// As words of a note, exact to the last bit; nothing for words that say none of `whole`.
std::string restart_words(const Restart& restart);
std::optional<Restart> restart_of_words(const std::string& words, const toolpath::Program& whole);

}  // namespace understudy::control
