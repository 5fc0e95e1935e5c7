"""Joint names of rig families: one table per family, by humanoid role.

A name is written without its side: "UpLeg" stands for LeftUpLeg, mixamorig:RightUpLeg or
UpLeg.L. Case and separators are ignored. Several names for one role are separated by spaces,
and the first one in the skeleton is used.
"""

SIDES = ("left", "right")
"""Prefixes of the roles with a side, and the order of columns with one value per side."""
CENTRAL_ROLES = ("hips", "spine", "chest", "upperChest", "neck", "head")
"""Roles without a side, each the child of the one before."""
ARM_ROLES = ("Shoulder", "UpperArm", "LowerArm", "Hand")
LEG_ROLES = ("UpperLeg", "LowerLeg", "Foot", "Toes")
FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
FINGER_ROLES = (
    "ThumbMetacarpal", "ThumbProximal", "ThumbDistal",
    *(f"{finger}{part}" for finger in FINGERS[1:]
      for part in ("Proximal", "Intermediate", "Distal")),
)  # fmt: skip

# The order of the names in each row below.
COLUMNS = (*CENTRAL_ROLES, *ARM_ROLES, *LEG_ROLES)

TABLES: dict[str, tuple[str, ...]] = {
    "VRM roles": (
        "hips", "spine", "chest", "upperChest", "neck", "head",
        "shoulder", "upperArm", "lowerArm", "hand",
        "upperLeg", "lowerLeg", "foot", "toes",
    ),
    "VRoid": (
        "J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_UpperChest", "J_Bip_C_Neck",
        "J_Bip_C_Head",
        "J_Bip_Shoulder", "J_Bip_UpperArm", "J_Bip_LowerArm", "J_Bip_Hand",
        "J_Bip_UpperLeg", "J_Bip_LowerLeg", "J_Bip_Foot", "J_Bip_ToeBase",
    ),
    "Mixamo": (  # also Perception Neuron and MotionBuilder
        "Hips", "Spine", "Spine1", "Spine3 Spine2", "Neck", "Head",
        "Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase",
    ),
    "CMU": (
        "Hips", "LowerBack", "Spine", "Spine1", "Neck", "Head",
        "Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase",
    ),
    "Acclaim": (  # its wrist is a twist joint within the forearm
        "root", "lowerback", "upperback", "thorax", "lowerneck", "head",
        "clavicle", "humerus", "radius", "hand wrist",
        "femur", "tibia", "foot", "toes",
    ),
    "Rokoko": (
        "Hips", "Spine1 Spine", "Spine2", "Spine4 Spine3", "Neck", "Head",
        "Shoulder", "Arm UpperArm", "ForeArm LowerArm", "Hand",
        "Thigh", "Shin", "Foot", "Toe",
    ),
    "Xsens": (
        "Pelvis", "L5", "T12 L3", "T8", "Neck", "Head",
        "Shoulder", "UpperArm", "ForeArm", "Hand",
        "UpperLeg", "LowerLeg", "Foot", "Toe",
    ),
    "Biovision": (  # also Xsens and OptiTrack, exported as BVH
        "Hips", "Chest", "Chest2", "Chest4 Chest3", "Neck", "Head",
        "Collar", "Shoulder", "Elbow", "Wrist",
        "Hip", "Knee", "Ankle", "Toe",
    ),
    "Unitree G1": (  # a robot; of three axes of a joint, the last carries the limb
        "pelvis", "waist_yaw", "waist_roll", "waist_pitch", "", "",
        "", "shoulder_yaw", "elbow", "wrist_yaw", "hip_yaw", "knee", "ankle_roll", "toe_base",
    ),
    "OpenSim": (  # its torso has no neck and head of their own
        "pelvis", "torso", "", "", "", "",
        "", "humerus", "ulna", "hand", "femur", "tibia", "talus", "toes",
    ),
    "OptiTrack": (
        "Hip", "Ab", "Chest", "UpperChest", "Neck", "Head",
        "Shoulder", "UArm", "FArm", "Hand", "Thigh", "Shin", "Foot", "Toe",
    ),
    "Vicon": (
        "Waist", "Spine", "Chest", "", "Neck", "Head",
        "Collar", "UpArm", "ForeArm", "Hand", "UpLeg", "LowLeg", "Foot", "Toes",
    ),
    "OpenNI": (  # fifteen joints; hands and feet are where wrists and ankles are
        "", "torso", "", "", "Neck", "Head",
        "", "Shoulder", "Elbow", "Hand",
        "Hip", "Knee", "Foot", "",
    ),
    "Kinect v1": (
        "HipCenter HipCentre Hip", "Spine", "", "", "ShoulderCenter ShoulderCentre", "Head",
        "", "Shoulder", "Elbow", "Wrist",
        "Hip", "Knee", "Ankle", "Foot",
    ),
    "Kinect v2": (
        "SpineBase", "SpineMid", "SpineShoulder", "", "Neck", "Head",
        "", "Shoulder", "Elbow", "Wrist",
        "Hip", "Knee", "Ankle", "Foot",
    ),
    "Azure Kinect": (
        "Pelvis", "SpineNavel SpineNaval", "SpineChest", "", "Neck", "Head",
        "Clavicle", "Shoulder", "Elbow", "Wrist",
        "Hip", "Knee", "Ankle", "Foot",
    ),
    "MediaPipe": (
        "hips_center", "trunk_center", "", "", "neck_center", "head_center",
        "", "shoulder", "elbow", "wrist",
        "hip", "knee", "ankle", "foot_index",
    ),
    "Unreal 5": (
        "pelvis", "spine_01", "spine_03", "spine_05", "neck_01", "head",
        "clavicle", "upperarm", "lowerarm", "hand",
        "thigh", "calf", "foot", "ball",
    ),
    "Unreal 4": (
        "pelvis", "spine_01", "spine_02", "spine_03", "neck_01", "head",
        "clavicle", "upperarm", "lowerarm", "hand",
        "thigh", "calf", "foot", "ball",
    ),
    "Biped": (
        "Pelvis", "Spine", "Spine1", "Spine3 Spine2", "Neck Neck1", "Head Head1",
        "Clavicle", "UpperArm", "Forearm", "Hand",
        "Thigh", "Calf", "Foot", "Toe0",
    ),
    "Character Creator": (
        "Hip Pelvis", "Waist", "Spine01", "Spine02", "NeckTwist01", "Head",
        "Clavicle", "Upperarm", "Forearm", "Hand",
        "Thigh", "Calf", "Foot", "ToeBase",
    ),
    "Poser": (
        "hip", "abdomen", "chest", "", "neck", "head",
        "Collar", "Shldr", "ForeArm", "Hand", "Thigh", "Shin", "Foot", "Toe",
    ),
    "DAZ": (
        "hip", "abdomenLower", "abdomenUpper chestLower", "chestUpper", "neckLower", "head",
        "Collar", "ShldrBend", "ForearmBend", "Hand",
        "ThighBend", "Shin", "Foot", "Toe",
    ),
    "Rigify": (
        "spine", "spine.001", "spine.002", "spine.003", "spine.004", "spine.006",
        "shoulder", "upper_arm", "forearm", "hand",
        "thigh", "shin", "foot", "toe",
    ),
    "Rigify deform bones": (
        "DEF-spine", "DEF-spine.001", "DEF-spine.002", "DEF-spine.003", "DEF-spine.004",
        "DEF-spine.006",
        "DEF-shoulder", "DEF-upper_arm", "DEF-forearm", "DEF-hand",
        "DEF-thigh", "DEF-shin", "DEF-foot", "DEF-toe",
    ),
    "Rigify controls": (  # spine_fk and spine_fk.001 turn the pelvis under the torso
        "torso hips", "spine_fk.002", "spine_fk.003", "", "neck", "head",
        "shoulder", "upper_arm_fk", "forearm_fk", "hand_fk",
        "thigh_fk", "shin_fk", "foot_fk", "toe_fk toe_ik toe",
    ),
    "Auto-Rig Pro": (
        "root.x", "spine_01.x", "spine_02.x", "spine_03.x", "neck.x", "head.x",
        "shoulder", "arm_stretch arm", "forearm_stretch forearm", "hand",
        "thigh_stretch thigh", "leg_stretch leg", "foot", "toes_01 toes",
    ),
    "Auto-Rig Pro controls": (
        "c_root_master.x c_root.x", "c_spine_01.x", "c_spine_02.x", "c_spine_03.x",
        "c_neck.x", "c_head.x",
        "c_shoulder", "c_arm_fk", "c_forearm_fk", "c_hand_fk",
        "c_thigh_fk", "c_leg_fk", "c_foot_fk", "c_toes_fk",
    ),
    "SMPL": (  # also SMPL-H, SMPL-X and what video models write
        "pelvis", "spine1", "spine2", "spine3", "neck", "head",
        "collar thorax inshoulder", "shoulder", "elbow", "wrist",
        "hip", "knee", "ankle", "foot toe",
    ),
    "SMPL in robotics": (
        "pelvis", "torso", "spine", "chest", "neck", "head",
        "thorax", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "toe",
    ),
    "SOMA": (
        "Hips", "Spine1", "Spine2", "Chest", "Neck1 Neck", "Head",
        "Shoulder", "Arm", "ForeArm", "Hand", "Leg", "Shin", "Foot", "ToeBase",
    ),
    "MHR": (
        "root", "c_spine0", "c_spine1", "c_spine3", "c_neck", "c_head",
        "clavicle", "uparm", "lowarm", "wrist",
        "upleg", "lowleg", "foot", "ball",
    ),
    "Talking With Hands": (  # of Meta, the recordings of the GENEA challenges
        "b_root", "spine0", "spine1", "spine3", "neck0", "head",
        "shoulder", "arm", "forearm", "wrist",
        "upleg", "leg", "foot", "ball",
    ),
    "mocopi": (
        "root", "torso_1", "torso_4", "torso_7", "neck_1", "head",
        "shoulder", "up_arm", "low_arm", "hand",
        "up_leg", "low_leg", "foot", "toes",
    ),
    "ARKit": (
        "hips", "spine_1", "spine_4", "spine_7", "neck_1", "head",
        "shoulder_1", "arm", "forearm", "hand",
        "upLeg", "leg", "foot", "toes",
    ),
    "MikuMikuDance": (  # names without side; 下半身 turns the pelvis, センター moves it
        "下半身 腰 センター", "上半身", "上半身2", "上半身3", "首", "頭",
        "肩", "腕", "ひじ", "手首",
        "足", "ひざ", "足首", "つま先 足先EX",
    ),
    "MikuMikuDance in English": (
        "lower_body waist center", "upper_body", "upper_body_2", "upper_body_3", "neck", "head",
        "shoulder", "arm", "elbow", "wrist",
        "leg", "knee", "ankle", "toe",
    ),
    "DAZ Genesis 9": (
        "hip", "spine1", "spine2", "spine4", "neck1", "head",
        "shoulder", "upperarm", "forearm", "hand",
        "thigh", "shin", "foot", "toes",
    ),
    "MakeHuman": (
        "root", "spine05", "spine03", "spine01", "neck01", "head",
        "clavicle", "upperarm01", "lowerarm01", "wrist",
        "upperleg01", "lowerleg01", "foot", "toe1-1",
    ),
    "Cascadeur": (
        "pelvis", "stomach", "chest", "", "neck", "head",
        "clavicle", "arm", "forearm", "hand",
        "thigh", "calf", "foot", "toe",
    ),
    "iPi": (
        "Hip", "LowerSpine", "MiddleSpine", "Chest", "Neck", "Head",
        "Clavicle", "Shoulder", "Forearm", "Hand",
        "Thigh", "Shin", "Foot", "Toe",
    ),
    "Meta": (  # Movement SDK and body tracking of OpenXR and WebXR
        "hips", "spine_lower", "spine_middle", "chest", "neck", "head",
        "shoulder", "arm_upper", "arm_lower", "hand_wrist",
        "upper_leg leg_upper", "lower_leg leg_lower", "foot_ankle", "foot_ball",
    ),
    "3ds Max CAT": (
        "pelvis hub001", "spine1", "spine2", "ribcage hub002", "neck1 neck", "head hub003",
        "armCollarbone", "armUpperarm", "armForearm", "armPalm",
        "legThigh", "legCalf", "legAnkle", "legDigit11",
    ),
    "Theia": (
        "pelvis", "abdomen", "thorax torso", "", "neck", "head",
        "clavicle", "uarm", "larm", "hand",
        "thigh", "shank", "foot", "toes",
    ),
    "Knees and elbows": (  # old skeletons of games and schools, with thighs below still hips
        "hips", "spine1", "spine2", "spine4 spine3", "neck neck1", "head",
        "clavicle", "shoulder", "elbow", "hand",
        "thigh", "knee", "foot", "toes",
    ),
    "Second Life": (
        "mPelvis", "mTorso", "mChest", "", "mNeck", "mHead",
        "mCollar", "mShoulder", "mElbow", "mWrist",
        "mHip", "mKnee", "mAnkle", "mFoot",
    ),
    "Bitmoji": (
        "C_spine0001", "C_spine0002 C_spine0006", "C_spine0006", "", "C_neck0001", "C_head0001",
        "clavicle", "armUpper0001", "armLower0001", "hand0001",
        "legUpper0001", "legLower0001", "foot0001", "foot0002",
    ),
    "Life Forms": (  # the first BVH files, of Biovision and Poser
        "Hips", "Chest Ab", "", "", "Neck", "Head",
        "Collar", "UpArm", "LowArm", "Hand",
        "UpLeg", "LowLeg", "Foot", "Toes",
    ),
    "Blender": (
        "hips hip pelvis", "spine torso abdomen waist", "chest spine1 spine01 spine001",
        "upperChest spine2 spine02 spine002", "neck", "head",
        "shoulder clavicle collar", "upperArm upArm arm", "lowerArm foreArm lowArm loArm",
        "hand wrist", "upperLeg upLeg thigh", "lowerLeg lowLeg loLeg shin calf leg",
        "foot ankle", "toes toe toeBase ball",
    ),
    "German": (
        "Becken Hüfte Huefte", "Wirbelsäule Wirbelsaeule Rücken", "Brust Oberkörper", "",
        "Hals Nacken", "Kopf",
        "Schlüsselbein Schluesselbein", "Schulter Oberarm", "Ellenbogen Ellbogen Unterarm",
        "Handgelenk Hand",
        "Hüfte Huefte Oberschenkel", "Knie Unterschenkel",
        "Fußgelenk Fussgelenk Knöchel Knoechel Sprunggelenk Fuß Fuss",
        "Zehen Zeh Zehe Fußspitze Fussspitze Fuß Fuss",
    ),
    "French": (
        "bassin hanches", "colonne dos", "poitrine thorax torse", "", "cou", "tête tete",
        "clavicule", "épaule epaule bras", "coude avantbras", "poignet main",
        "hanche cuisse", "genou jambe", "cheville pied", "orteils orteil pied",
    ),
    "Spanish": (
        "pelvis caderas cadera", "columna espalda", "pecho tórax torax", "", "cuello", "cabeza",
        "clavícula clavicula", "hombro brazo", "codo antebrazo", "muñeca muneca mano",
        "cadera muslo", "rodilla pierna", "tobillo pie", "dedos punta pie",
    ),
    "Japanese": (  # of keypoints: the shoulder is the joint of the arm
        "骨盤 腰", "背骨 脊椎", "胸", "", "首", "頭",
        "鎖骨", "肩", "肘 ひじ", "手首",
        "股関節 腰", "膝 ひざ", "足首", "つま先 爪先",
    ),
    "Chinese": (
        "骨盆 盆骨 臀部", "脊柱 脊椎 腰部 腰", "胸部 胸", "", "颈部 脖子 颈", "头部 头",
        "锁骨", "肩 肩膀 肩部 上臂", "肘 手肘 肘部 前臂", "手腕 腕 腕部 手",
        "髋 髋部 胯 大腿", "膝 膝盖 膝部 小腿", "脚踝 踝 足踝 脚", "脚趾 脚尖 脚",
    ),
}  # fmt: skip
