// Open CASCADE's own notes of progress, passed on. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/IsolatedRun.h>

#include <Message_ProgressIndicator.hxx>

namespace cadrefine
{

/// Calls noteProgress() wherever an algorithm of Open CASCADE that gets a range of it comes on.
/// Usage: const Handle(OccProgress) progress = new OccProgress; algorithm(progress->Start());
class OccProgress : public Message_ProgressIndicator
{
protected:
  void Show(const Message_ProgressScope&, Standard_Boolean) override { noteProgress(); }
};

} // namespace cadrefine
