#ifndef pqMenuReasons_h
#define pqMenuReasons_h

#include <QObject>

/// Greys filters of the menu out where their input lacks an array that they need, or has one that
/// tells that it is something else, and says why in the status bar. The conditions are hints of the
/// input property:
///
///     <MenuCondition attribute_type="point" array="CADParameters" reason="Apply ... first"
///       details="The mesh does not know ..."/>
///
/// attribute_type is point, cell or field; present="0" asks for data without the array. The status
/// bar has room for a reason of 42 characters; the details go to the tool tip. Hints, and
/// no domain of our own: a client that has not loaded the plugin takes the filters' descriptions
/// from its server, and could not read such a domain.
class pqMenuReasons : public QObject
{
  Q_OBJECT

public:
  explicit pqMenuReasons(QObject* parent = nullptr);

  void startup();
  void shutdown();

private:
  void explain();
};

#endif
