#include "ParallelTest.h"

#include <vtkMPIController.h>
#include <vtkNew.h>

#include <iostream>
#include <memory>

namespace cadrefine
{

namespace
{

vtkMultiProcessController* world = nullptr;

// For ranks but the first: failures only, with the rank.
class FailurePrinter : public testing::EmptyTestEventListener
{
public:
  void OnTestPartResult(const testing::TestPartResult& result) override
  {
    if (result.failed())
    {
      std::cerr << "rank " << world->GetLocalProcessId() << ": " << result.file_name() << ":"
                << result.line_number() << ": " << result.message() << "\n";
    }
  }
};

int runTests(vtkMultiProcessController* controller)
{
  world = controller;
  if (controller->GetLocalProcessId() > 0)
  {
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailurePrinter); // the list owns it
  }
  const bool failed = RUN_ALL_TESTS() != 0;
  return RankExchange(controller).any(failed) ? 1 : 0;
}

} // namespace

vtkMultiProcessController* worldController()
{
  return world;
}

} // namespace cadrefine

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv, 0);
  const int status = cadrefine::runTests(controller);
  controller->Finalize();
  return status;
}
