#ifndef pqReaderChoice_h
#define pqReaderChoice_h

#include <QObject>

/// Answers ParaView's question which reader shall open a file, where Mesh Reader is among a few: it
/// has looked into the file, while Fluent's (.msh), AVS UCD's (.inp) and BDF's take each of their
/// ending. "All Files" in the dialog of File > Open asks for one of all readers, and is left alone.
class pqReaderChoice : public QObject
{
  Q_OBJECT

public:
  explicit pqReaderChoice(QObject* parent = nullptr);

  void startup();
  void shutdown();

protected:
  bool eventFilter(QObject* window, QEvent* event) override;
};

#endif
