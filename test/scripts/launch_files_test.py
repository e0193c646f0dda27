#!/usr/bin/env python3
"""What the launch files make of the paths that users give."""
import os
import re
import shlex
import unittest

import roslaunch.config

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def nodes_of(launch_file, arguments):
    """The nodes by their names, as roslaunch would start them."""
    os.environ['ROS_PACKAGE_PATH'] = ROOT + ':' + os.environ.get('ROS_PACKAGE_PATH', '/usr/share')
    os.environ.update(HOME='/home/user', PWD='/where/i am')
    file_and_arguments = [(os.path.join(ROOT, 'launch', launch_file), arguments)]
    config = roslaunch.config.load_config_default(file_and_arguments, None, verbose=False)
    return {node.name: node for node in config.nodes}, config.params


class ReplayTest(unittest.TestCase):

    def bags_of(self, bag):
        nodes, _ = nodes_of('replay.launch', ['bag:=' + bag, 'rviz:=false'])
        return [word for word in shlex.split(nodes['rosbag_play'].args) if not word.startswith('-')]

    def test_paths_may_be_relative_have_blanks_or_begin_with_the_home(self):
        for bag, path in (('/a/room.bag', '/a/room.bag'), ('/a/my room.bag', '/a/my room.bag'),
                          ('room.bag', '/where/i am/room.bag'), ('~/my room.bag', '/home/user/my room.bag')):
            self.assertEqual(self.bags_of(bag), [path])

    def test_several_bags_are_played(self):
        self.assertEqual(self.bags_of('/a/0.bag 1.bag ~/my room.bag'),
                         ['/a/0.bag', '/where/i am/1.bag', '/home/user/my room.bag'])


class ReconstructionTest(unittest.TestCase):

    def test_what_an_earlier_launch_left_of_any_stage_is_cleared(self):
        os.environ['ROS_PACKAGE_PATH'] = ROOT + ':' + os.environ.get('ROS_PACKAGE_PATH', '/usr/share')
        config = roslaunch.config.load_config_default(
            [(os.path.join(ROOT, 'launch', 'reconstruction.launch'), ['navigation:=true'])], None, verbose=False)
        with open(os.path.join(ROOT, 'docs', 'ros_api.md')) as api:
            stages = set(re.findall(r'<!-- parameters of (\w+) -->', api.read()))
        stages -= {'acquisition'}  # another launch file's, and the nodelet's own
        self.assertGreater(len(stages), 10)
        self.assertEqual(stages - {name.strip('/').split('/')[-1] for name in config.clear_params}, set())


class DemoTest(unittest.TestCase):

    def test_paths_may_be_relative_have_blanks_or_begin_with_the_home(self):
        for given, path in (('/a/my room', '/a/my room'), ('room', '/where/i am/room'),
                            ('~/room.bag', '/home/user/room.bag')):
            _, params = nodes_of('demo.launch', ['recording:=' + given, 'rviz:=false'])
            self.assertEqual(params['/depth_fusion/acquisition/recording'].value, path)


if __name__ == '__main__':
    unittest.main()
