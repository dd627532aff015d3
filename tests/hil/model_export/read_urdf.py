"""What Python's own XML reader finds in a URDF: mass, centre of mass, yaw inertia about the origin, joints. Words and numbers."""
import sys
import xml.etree.ElementTree as tree

robot = tree.parse(sys.argv[1]).getroot()
where = {"base_link": (0.0, 0.0, 0.0)}
for joint in robot.findall("joint"):
    where[joint.find("child").get("link")] = tuple(map(float, joint.find("origin").get("xyz").split()))
mass, moment, yaw = 0.0, [0.0, 0.0, 0.0], 0.0
for link in robot.findall("link"):
    inertial = link.find("inertial")
    m = float(inertial.find("mass").get("value"))
    at = [a + b for a, b in zip(where[link.get("name")], map(float, inertial.find("origin").get("xyz").split()))]
    mass += m
    moment = [a + m * b for a, b in zip(moment, at)]
    yaw += float(inertial.find("inertia").get("izz")) + m * (at[0] ** 2 + at[1] ** 2)
print("mass", repr(mass))
print("com", *(repr(a / mass) for a in moment))
print("yaw", repr(yaw))
print("name", robot.get("name"))
for joint in robot.findall("joint"):
    d, lim = joint.find("dynamics"), joint.find("limit")
    print(joint.get("name"), joint.find("axis").get("xyz"), d.get("damping"), d.get("friction"), lim.get("effort"))
