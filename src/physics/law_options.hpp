// The options that the laws of physics/laws.hpp bring along.
#pragma once

namespace cdem {

/// Enters every law's name and properties into the registry of options, where they are not listed yet. Call once, before
/// anything is read.
void RegisterLawOptions();

}  // namespace cdem
