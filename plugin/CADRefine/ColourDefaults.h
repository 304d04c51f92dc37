// How ParaView colours the arrays of the filters, if the user has saved no colours for them.
#pragma once

/// Adds default colours for the arrays by their names: CAD entities, dimensions and flags as
/// categories, a perceptually uniform map for errors, distances and qualities. Called when the
/// plugin is loaded; what the user or the site saves as default for an array stands above it.
void addColourDefaults();
