// The numbers in the text of a STEP file. Private to geom/cad.
#pragma once

#include <string>

namespace cadrefine
{

/// Throws Error where the data of a STEP file hold a number of 1e308 or more (1.E999), which
/// would become infinite: Open CASCADE computes for ever on such points and weights. Work:
/// reads the file once.
void checkStepNumbers(const std::string& path);

} // namespace cadrefine
