// What only the ParaView window needs is a plugin of its own: Qt takes half a second of each start,
// and memory, that pvpython, pvbatch and each rank of pvserver do not pay.
#pragma once

/// In the ParaView window, loads the plugin CADRefineWindow, which is beside this one; elsewhere
/// nothing. Called when this plugin is loaded.
void loadWindowPlugin();
